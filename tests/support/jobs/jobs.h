// Jobs for tests of the whole chain, and checks that every program must pass. The checks do not use
// cam/verify: they read the text of the program and use closest points and plain distances to the cutting
// moves.
#pragma once

#include <string>
#include <vector>

#include "cam/plan/plan.h"
#include "tests/support/random.h"
#include "tests/support/sanitized.h"

namespace patchmill::testing {

inline constexpr double kTestFeed = 1200.0, kTestPlungeFeed = 400.0;  // mm/min

// A valid job for a ball of this radius; the floor lies far below the part when `deep`. It may leave
// everything into which the ball does not fit.
inline Job BallJob(double radius, bool deep = true) {
  Job job;
  Operation& op = job.operation;
  op.tool.cutter = BallEnd{radius};
  op.tool.spindle_rpm = 12000;
  op.tool.feed = kTestFeed;
  op.tool.plunge_feed = kTestPlungeFeed;
  if (deep) op.floor_z = -1000.0;
  op.max_unreached = 1.0;
  return job;
}

// BuildPlacedSurface, which must succeed.
Surface PlacedSurface(const PatchModel& model, const Setup& setup = {});

// RunJob, which must give an answer.
JobResult Mill(const Surface& surface, const Job& job, int threads = 0);

// "COMPLETE, gouge 0.004, leftover 0.012 ...": for messages of failing tests.
std::string Describe(const JobResult& result);

// mm^2, of the regions that the ball does not reach for this reason.
double AreaFor(const JobResult& result, UnreachableReason reason);

// Fails the test unless the result carries a verified program that keeps [verification P1, P2, P3] at
// `samples` random places of its moves and of the surface. Under a forced strategy leftover is judged where
// that can finish (not at all where lines have an angle of their own in each region). Program zero must be
// the model origin and the heights the default ones (floor_z apart). The text is read by the job's dialect.
void CheckProgram(const Surface& surface, const Job& job, const JobResult& result, Random& random,
                  int samples);

// Mill and CheckProgram at a thousand places, for a job that must be verified. No point may be raised by its
// certificate, and the job may take one minute of processor time.
JobResult MillChecked(const Surface& surface, const Job& job = BallJob(3.0));

}  // namespace patchmill::testing
