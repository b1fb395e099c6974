#include "clients/cli/progress_bar.h"

#include <algorithm>
#include <cstdio>
#include <string>

#include <fmt/format.h>
#include <unistd.h>

namespace patchmill::cli {

namespace {
constexpr int kWidth = 30;
}

ProgressBar::ProgressBar(bool quiet) : wanted_(!quiet && isatty(STDERR_FILENO) == 1) {}

void ProgressBar::Show(const v1::Progress& progress) {
  if (!wanted_) return;
  if (progress.queue_place() > 0) {
    fmt::print(stderr, "\r\033[Kthe server is busy: place {} in its queue", progress.queue_place());
  } else {
    // A server of an earlier version knows only the share of the step.
    const bool whole = progress.job_stage() != v1::JOB_STAGE_UNSPECIFIED;
    const double fraction = std::clamp(whole ? progress.overall_fraction() : progress.fraction(), 0.0, 1.0);
    const auto done = static_cast<std::size_t>(fraction * kWidth);
    const std::string rest = progress.has_remaining_s() && progress.remaining_s() >= 1.0
                                 ? fmt::format("about {:.0f} s left", progress.remaining_s())
                                 : std::string();
    fmt::print(stderr, "\r\033[K[{}{}] {:3.0f} % {:<24.24} {}", std::string(done, '#'),
               std::string(kWidth - done, ' '), 100.0 * fraction, progress.stage(), rest);
  }
  std::fflush(stderr);
  shown_ = true;
}

void ProgressBar::Clear() {
  if (!shown_) return;
  fmt::print(stderr, "\r\033[K");
  std::fflush(stderr);
  shown_ = false;
}

}  // namespace patchmill::cli
