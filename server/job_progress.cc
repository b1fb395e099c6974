#include "server/job_progress.h"

#include <algorithm>
#include <array>
#include <utility>

namespace patchmill {
namespace {

// First words of the names of steps. "location" and "bounds" occur in several stages.
constexpr std::array<std::pair<std::string_view, v1::JobStage>, 22> kStages = {{
    {"model", v1::JOB_STAGE_MODEL},
    {"import", v1::JOB_STAGE_MODEL},
    {"trim", v1::JOB_STAGE_MODEL},
    {"joins", v1::JOB_STAGE_MODEL},
    {"curves", v1::JOB_STAGE_MODEL},
    {"faces", v1::JOB_STAGE_MODEL},
    {"pieces", v1::JOB_STAGE_MODEL},
    {"fairing", v1::JOB_STAGE_MODEL},
    {"regions", v1::JOB_STAGE_REGIONS},
    {"obstacles", v1::JOB_STAGE_REGIONS},
    {"zigzag", v1::JOB_STAGE_PASSES},
    {"contours", v1::JOB_STAGE_PASSES},
    {"border passes", v1::JOB_STAGE_PASSES},
    {"coverage", v1::JOB_STAGE_PASSES},
    {"redundant passes", v1::JOB_STAGE_PASSES},
    {"link", v1::JOB_STAGE_LINKS},
    {"verify", v1::JOB_STAGE_VERIFICATION},
    {"triangles", v1::JOB_STAGE_DRAWING},
    {"leftover at vertices", v1::JOB_STAGE_DRAWING},
    {"flow lines", v1::JOB_STAGE_DRAWING},
    {"crossings", v1::JOB_STAGE_DRAWING},
    {"reach", v1::JOB_STAGE_REGIONS},
}};

// Where a stage begins, as a share of the whole job. From the medians of the stages of six parts (teapot, two
// hills, mouse, bonnet, a cavity, a core; `patchmill mill PART --scallop 0.02 --report`): regions 9 %, passes
// 39 %, links 4 %, verification 47 %. The shares of the model and of drawing are guesses.
double StartOf(v1::JobStage stage) {
  switch (stage) {
    case v1::JOB_STAGE_MODEL:
      return 0.0;
    case v1::JOB_STAGE_REGIONS:
      return 0.02;
    case v1::JOB_STAGE_PASSES:
      return 0.11;
    case v1::JOB_STAGE_LINKS:
      return 0.48;
    case v1::JOB_STAGE_VERIFICATION:
      return 0.52;
    case v1::JOB_STAGE_DRAWING:
      return 0.97;
    default:
      return 0.0;
  }
}

double EndOf(v1::JobStage stage) {
  return stage < v1::JOB_STAGE_MODEL      ? 0.0
         : stage == v1::JOB_STAGE_DRAWING ? 1.0
                                          : StartOf(static_cast<v1::JobStage>(stage + 1));
}

}  // namespace

std::optional<v1::JobStage> StageOfStep(std::string_view step) {
  for (const auto& [first, stage] : kStages) {
    if (step.substr(0, first.size()) == first) return stage;
  }
  return std::nullopt;
}

void JobProgress::Step(std::string_view step, double fraction) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!began_) began_ = Clock::now();
  const v1::JobStage stage =
      std::max(stage_, StageOfStep(step).value_or(std::max(stage_, v1::JOB_STAGE_MODEL)));
  if (stage != stage_) {
    stage_ = stage;
    done_before_step_ = share_of_stage_ = 0.0;
  } else if (step_ != step) {
    done_before_step_ = share_of_stage_;
  }
  step_ = step;
  fraction_ = std::clamp(fraction, 0.0, 1.0);
  // Nobody knows how many steps follow: each takes half of what is left of its stage.
  share_of_stage_ =
      std::max(share_of_stage_, done_before_step_ + 0.5 * (1.0 - done_before_step_) * fraction_);
}

void JobProgress::Queue(int place) {
  const std::lock_guard<std::mutex> lock(mutex_);
  queue_place_ = place;
  if (place > 0) stage_ = std::max(stage_, v1::JOB_STAGE_QUEUED);
}

v1::Progress JobProgress::Now(Clock::time_point now) {
  const std::lock_guard<std::mutex> lock(mutex_);
  v1::Progress progress;
  progress.set_stage(step_);
  progress.set_fraction(fraction_);
  progress.set_job_stage(stage_);
  progress.set_queue_place(queue_place_);
  const double done = StartOf(stage_) + share_of_stage_ * (EndOf(stage_) - StartOf(stage_));
  progress.set_overall_fraction(done);
  constexpr double kLeast = 0.1;  // of the job, before its remaining time is estimated
  if (began_ && done >= kLeast) {
    const std::chrono::duration<double> took = now - *began_;
    progress.set_remaining_s(took.count() * (1.0 - done) / done);
  }
  return progress;
}

}  // namespace patchmill
