// What the readers of model text share: patches in file order with the line each began on.
#pragma once

#include <string_view>
#include <vector>

#include <absl/status/statusor.h>

#include "core/io/text_scanner.h"
#include "core/network/patch_model.h"

namespace patchmill {

// `count` points; `count` is at most that of degree 15 x 15, so nothing is reserved on a file's word.
absl::StatusOr<std::vector<Vec3>> ReadPoints(TextScanner& scanner, int count);
// The same with weights: `wx wy wz w` per point, already multiplied; returned divided. A weight of 0, a point
// at infinity, fails with the code ZERO_WEIGHT.
struct RationalPoints {
  std::vector<Vec3> points;
  std::vector<double> weights;
};
absl::StatusOr<RationalPoints> ReadRationalPoints(TextScanner& scanner, int count);
// A net of slow x fast entries whose first direction runs fastest, as a net whose second one does.
template <class T>
std::vector<T> SecondFastest(const std::vector<T>& net, int slow, int fast) {
  std::vector<T> out(net.size());
  for (int i = 0; i < slow; ++i) {
    for (int j = 0; j < fast; ++j) {
      out[static_cast<std::size_t>(j * slow + i)] = net[static_cast<std::size_t>(i * fast + j)];
    }
  }
  return out;
}
absl::StatusOr<int> ReadDegree(TextScanner& scanner, std::string_view what);
// The number of patches a header claims: 1..100000, and no more than the rest of the text can hold when every
// patch takes at least `bytes_per_patch` bytes.
absl::StatusOr<int> ReadPatchCount(TextScanner& scanner, std::size_t bytes_per_patch);

class ModelBuilder {
 public:
  // Fails on the patch after the 100000th and when the control points exceed their limit.
  absl::Status Add(const TextScanner& scanner, int line, PatchShape shape);
  // Expects the end of the text, validates the whole; the error names the line of the first bad patch.
  absl::StatusOr<PatchModel> Finish(TextScanner& scanner);
  bool empty() const { return model_.patches.empty(); }

 private:
  PatchModel model_;
  std::vector<int> lines_;
  std::size_t points_ = 0;
};

}  // namespace patchmill
