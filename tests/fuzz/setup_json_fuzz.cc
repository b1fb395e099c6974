// libFuzzer: any bytes as the JSON of a set-up: machine, stock, obstacles. What is accepted is a set-up whose
// message reads back as the same.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "proto/json/json_message.h"
#include "server/convert/setup.h"
#include "server/errors.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace patchmill;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  v1::Setup proto;
  if (!ReadJsonMessage(text, proto).ok()) {
    proto.Clear();
    if (!ReadJsonMessage(text, *proto.mutable_machine()).ok()) return 0;
  }
  FieldErrors errors;
  const Setup setup = FromProto(proto, "setup", errors);
  if (!errors.empty()) return 0;
  const v1::Setup written = ToProto(setup);
  FieldErrors more;
  const v1::Setup again = ToProto(FromProto(written, "setup", more));
  if (!more.empty() || again.SerializeAsString() != written.SerializeAsString()) __builtin_trap();
  return 0;
}
