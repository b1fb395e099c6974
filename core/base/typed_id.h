// Typed indices: a PatchId is not a PieceId. An absent id is an empty std::optional. Regions and components
// are the exception: grids hold millions of their ids, so "none" is a value of the same four bytes.
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

using PatchId = TypedId<struct PatchTag>;          // a patch as given, in the order of the model
using FaceId = TypedId<struct FaceTag>;            // a face of a PatchModel, in its order
using PieceId = TypedId<struct PieceTag>;          // a rational Bernstein rectangle of a Surface
using RegionId = TypedId<struct RegionTag>;        // a region of a RegionMap
using ComponentId = TypedId<struct ComponentTag>;  // a connected component of a region of a RegionMap

// No region and no component. They come before all others in order, and have no index. Everything outside
// the program (the wire, digests) sees them as -1.
inline constexpr RegionId kNoRegion{std::int32_t{-1}};
inline constexpr ComponentId kNoComponent{std::int32_t{-1}};

}  // namespace patchmill
