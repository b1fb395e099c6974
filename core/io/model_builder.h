// Parts that the readers of model text share. A model holds its patches in file order; each remembers its
// first line.
#pragma once

#include <string_view>
#include <vector>

#include <absl/status/statusor.h>

#include "core/io/text_scanner.h"
#include "core/network/patch_model.h"

namespace patchmill {

// Reads `count` points. `count` is at most that of degree 15 x 15, so a false count in a file costs no
// memory.
absl::StatusOr<std::vector<Vec3>> ReadPoints(TextScanner& scanner, int count);
// Points with weights, read as `wx wy wz w`: already multiplied by the weight. They are returned divided by
// it. A weight of 0, a point at infinity, fails with the code ZERO_WEIGHT.
struct RationalPoints {
  std::vector<Vec3> points;
  std::vector<double> weights;
};
absl::StatusOr<RationalPoints> ReadRationalPoints(TextScanner& scanner, int count);
// Transposes a net of slow x fast entries whose first direction runs fastest, so that the second one does.
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
// Reads the number of patches that a header claims. It must be 1 to 100000. Also, the rest of the text must
// have room for that many patches of at least `bytes_per_patch` bytes each.
absl::StatusOr<int> ReadPatchCount(TextScanner& scanner, std::size_t bytes_per_patch);

class ModelBuilder {
 public:
  // Fails on the patch after the 100000th, and if the control points exceed their limit.
  absl::Status Add(const TextScanner& scanner, int line, PatchShape shape);
  // Expects the end of the text and validates the whole model. The error names the line of the first bad
  // patch.
  absl::StatusOr<PatchModel> Finish(TextScanner& scanner);
  bool empty() const { return model_.patches.empty(); }

 private:
  PatchModel model_;
  std::vector<int> lines_;
  std::size_t points_ = 0;
};

}  // namespace patchmill
