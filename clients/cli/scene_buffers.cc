#include "clients/cli/scene_buffers.h"

#include <bit>

namespace patchmill::cli {

static_assert(std::endian::native == std::endian::little, "the page reads little-endian numbers");

void SceneBuffers::AddBytes(std::string_view name, std::string_view type, std::string_view bytes,
                            std::size_t count) {
  google::protobuf::Struct& entry = *(*table_.mutable_fields())[std::string(name)].mutable_struct_value();
  (*entry.mutable_fields())["type"].set_string_value(std::string(type));
  (*entry.mutable_fields())["offset"].set_number_value(static_cast<double>(bytes_.size()));
  (*entry.mutable_fields())["count"].set_number_value(static_cast<double>(count));
  bytes_ += bytes;
  bytes_.resize((bytes_.size() + 3) / 4 * 4);
}

}  // namespace patchmill::cli
