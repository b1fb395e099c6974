// A small JSON reader for test vectors and golden files. Not hardened: a mistake in the file throws.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/base/vec.h"

namespace patchmill::testing {

struct Json {
  using Array = std::vector<Json>;
  using Object = std::map<std::string, Json>;
  std::variant<std::nullptr_t, bool, double, std::string, Array, Object> value;

  double Number() const { return std::get<double>(value); }
  const std::string& String() const { return std::get<std::string>(value); }
  bool Bool() const { return std::get<bool>(value); }
  const Array& Items() const { return std::get<Array>(value); }
  const Object& Members() const { return std::get<Object>(value); }
  bool Has(const std::string& key) const { return Members().count(key) > 0; }
  Vec3 Vector() const { return {(*this)[0].Number(), (*this)[1].Number(), (*this)[2].Number()}; }

  const Json& operator[](const std::string& key) const { return Members().at(key); }
  const Json& operator[](const char* key) const { return Members().at(key); }
  const Json& operator[](int index) const { return Items().at(static_cast<std::size_t>(index)); }
};

// Throws std::runtime_error with the byte offset of the fault.
Json ParseJson(std::string_view text);
// LoadJson(PATCHMILL_SOURCE_DIR "/tests/vectors/gregory_quad.json")
Json LoadJson(const std::string& path);

}  // namespace patchmill::testing
