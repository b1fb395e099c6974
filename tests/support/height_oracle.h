// h by brute force, to check cam/location. It samples every patch densely in its native form and improves the
// best samples by a direct search. It shares no code with cam/location: no pieces, no bounds, no derivatives.
#pragma once

#include <vector>

#include "core/network/patch_model.h"

namespace patchmill::testing {

class HeightOracle {
 public:
  // `samples` a side of every patch.
  HeightOracle(const PatchModel& model, double radius, int samples);

  struct Answer {
    double sampled = -kInfinity;   // the best sample: never above h
    double polished = -kInfinity;  // the best local maximum found from the best samples: never above h
  };
  Answer Height(const Vec2& q) const;

 private:
  struct Sample {
    Vec3 p;
    int patch;
    float u, v;
  };
  double Value(const Vec2& q, int patch, double u, double v) const;
  double Polish(const Vec2& q, const Sample& start) const;

  const PatchModel& model_;
  double radius_;
  double step_;  // parameter step of the samples
  std::vector<Sample> samples_;
};

}  // namespace patchmill::testing
