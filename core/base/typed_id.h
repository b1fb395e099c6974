// Typed indices: a PatchId is not a PieceId. An absent id is an empty std::optional, never a special value.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>

namespace patchmill {

template <class Tag>
struct TypedId {
  std::int32_t value = 0;
  constexpr TypedId() = default;
  constexpr explicit TypedId(std::int32_t v) : value(v) {}
  constexpr explicit TypedId(std::size_t v) : value(static_cast<std::int32_t>(v)) {}
  constexpr std::size_t index() const { return static_cast<std::size_t>(value); }
  constexpr auto operator<=>(const TypedId&) const = default;
};

using PatchId = TypedId<struct PatchTag>;  // a patch as given, in the order of the model
using PieceId = TypedId<struct PieceTag>;  // a rational Bernstein rectangle of a Surface
using RegionId = TypedId<struct RegionTag>;

}  // namespace patchmill
