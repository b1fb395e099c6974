// Bytes of requests, counted before they are parsed. The first byte picks the request.
#include <cstdint>
#include <cstdlib>

#include "patchmill/v1/model_service.pb.h"
#include "patchmill/v1/toolpath_service.pb.h"
#include "tests/fuzz/wire_count_contract.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  patchmill::v1::GenerateProgramRequest job;
  patchmill::v1::EditModelRequest edit;
  google::protobuf::Message& message = data[0] % 2 == 0 ? static_cast<google::protobuf::Message&>(job) : edit;
  if (!patchmill::KeepsWireCountContract(bytes, message)) std::abort();
  return 0;
}
