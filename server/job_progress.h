// Progress of a whole job, made from the steps that its computation reports.
#pragma once

#include <chrono>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "patchmill/v1/report.pb.h"

namespace patchmill {

// The stage that a step belongs to, by the step's name ("zigzag: ends"). Nothing for a step that occurs in
// several stages.
std::optional<v1::JobStage> StageOfStep(std::string_view step);

// Collects the steps of one job. Any thread may call it.
class JobProgress {
 public:
  using Clock = std::chrono::steady_clock;

  // `fraction` in [0, 1] of the step is done.
  void Step(std::string_view step, double fraction);
  // The job waits at this place of the queue, from 1; 0: it runs.
  void Queue(int place);
  // The newest state. overall_fraction and job_stage never decrease from one call to the next.
  v1::Progress Now(Clock::time_point now = Clock::now());

 private:
  std::mutex mutex_;
  std::string step_;
  double fraction_ = 0.0;
  int queue_place_ = 0;
  v1::JobStage stage_ = v1::JOB_STAGE_UNSPECIFIED;
  double done_before_step_ = 0.0;  // share of the stage that was done when the step began
  double share_of_stage_ = 0.0;
  std::optional<Clock::time_point> began_;
};

}  // namespace patchmill
