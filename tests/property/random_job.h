// Jobs over random parts. Each job is drawn from one seed.
#pragma once

#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/fuzz.h"
#include "tests/support/jobs/jobs.h"
#include "tests/support/shapes.h"

namespace patchmill::testing {

struct RandomJob {
  PatchModel model;
  Job job;
  std::string text;  // what was drawn
};

inline RandomJob DrawJob(std::uint64_t seed, bool folds, bool rational) {
  Random random(seed);
  RandomBsplineParams part;
  part.spans = 3 + random.Int(folds ? 2 : 3);
  part.size = folds ? random.Uniform(10.0, 16.0) : random.Uniform(15.0, 25.0);
  part.amplitude = random.Uniform(1.0, 4.0);
  part.folds = folds;
  part.rational = rational;

  RandomJob drawn;
  drawn.model = RandomBspline(seed, part);
  const double radius = random.Uniform(1.5, 5.0);
  drawn.job = BallJob(radius, random.Int(2) == 0);
  Operation& op = drawn.job.operation;
  op.scallop = 0.01 * std::exp(random.Uniform(0.0, std::log(5.0)));
  op.tolerance = 0.01 * std::exp(random.Uniform(0.0, std::log(4.0)));
  op.steep_angle = Radians(random.Uniform(15.0, 75.0));
  op.zigzag_angle = random.Uniform(0.0, kPi);
  op.leave = random.Int(3) == 0 ? random.Uniform(0.05, 0.4) : 0.0;
  op.contour_direction = static_cast<CutDirection>(random.Int(3));
  drawn.text = fmt::format(
      "seed {}: {} spans, size {:.2f}, amplitude {:.2f}{}{}; R {:.3f}, scallop "
      "{:.4f}, tolerance {:.4f}, "
      "steep {:.1f}, angle {:.1f}, leave {:.3f}, direction {}, floor {}",
      seed, part.spans, part.size, part.amplitude, folds ? ", folds" : "", rational ? ", rational" : "",
      radius, op.scallop, op.tolerance, Degrees(op.steep_angle), Degrees(op.zigzag_angle), op.leave,
      static_cast<int>(op.contour_direction), op.floor_z ? "deep" : "at the lowest point");
  return drawn;
}

// Whatever the part and the parameters: a verified program that keeps the
// promises.
inline void ExpectPromisesKept(const RandomJob& drawn, std::uint64_t seed) {
  SCOPED_TRACE(drawn.text);
  const Surface surface = PlacedSurface(drawn.model);
  Random random(seed + 1000);
  CheckProgram(surface, drawn.job, Mill(surface, drawn.job), random, kSanitized ? 50 : 500);
}

}  // namespace patchmill::testing
