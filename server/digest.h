// What a request is, in 32 bytes: SHA-256 (OpenSSL's libcrypto, which gRPC links anyway) over resolved values
// in the server's own order, never over wire bytes.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "cam/plan/job.h"
#include "core/network/patch_model.h"

namespace patchmill {

std::string Sha256(std::string_view bytes);  // 32 bytes
std::string Hex(std::string_view bytes);     // lower case

// Appends values in one defined way, so that equal values give equal bytes on every machine: numbers little
// endian, strings with their length, -0 as 0.
class Canonical {
 public:
  Canonical& Add(double value);
  Canonical& Add(std::int64_t value);
  Canonical& Add(std::string_view value);
  std::string Digest() const { return Sha256(bytes_); }

 private:
  std::string bytes_;
};

// Over units-resolved control points (mm), kinds, degrees, knots, weights and ids, in the order of the model.
std::string ModelDigest(const PatchModel& model);

// Over everything the program depends on, the model by its digest; not over threads, outputs or request ids.
std::string JobDigest(const Job& job, std::string_view model_digest, std::string_view name);

// Over ids, kinds, slopes, reasons and borders.
std::string RegionsDigest(const RegionMap& map);

}  // namespace patchmill
