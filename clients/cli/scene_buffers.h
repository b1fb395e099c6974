// The binary part of a 3-D page: named arrays, one behind the other (clients/viewer/SCENE.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <google/protobuf/struct.pb.h>

namespace patchmill::cli {

class SceneBuffers {
 public:
  // Adds an array of float ("f32"), std::uint32_t ("u32"), std::int32_t ("i32") or std::uint8_t ("u8").
  template <class T>
  void Add(std::string_view name, const std::vector<T>& values) {
    const auto* bytes = reinterpret_cast<const char*>(values.data());
    AddBytes(name, TypeOf(T()), {bytes, values.size() * sizeof(T)}, values.size());
  }
  // Adds text as an array of its bytes.
  void Add(std::string_view name, std::string_view text) { AddBytes(name, "u8", text, text.size()); }

  // Name, type, place and length of each array.
  const google::protobuf::Struct& table() const { return table_; }
  const std::string& bytes() const { return bytes_; }

 private:
  static std::string_view TypeOf(float) { return "f32"; }
  static std::string_view TypeOf(std::uint32_t) { return "u32"; }
  static std::string_view TypeOf(std::int32_t) { return "i32"; }
  static std::string_view TypeOf(std::uint8_t) { return "u8"; }
  void AddBytes(std::string_view name, std::string_view type, std::string_view bytes, std::size_t count);

  google::protobuf::Struct table_;
  std::string bytes_;
};

}  // namespace patchmill::cli
