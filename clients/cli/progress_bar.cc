#include "clients/cli/progress_bar.h"

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

namespace patchmill::cli {

namespace {
constexpr int kWidth = 30;
}

ProgressBar::ProgressBar(bool quiet) : wanted_(!quiet && isatty(STDERR_FILENO) == 1) {}

void ProgressBar::Show(const v1::Progress& progress) {
  if (!wanted_) return;
  const double fraction = std::clamp(progress.fraction(), 0.0, 1.0);
  const auto done = static_cast<std::size_t>(fraction * kWidth);
  fmt::print(stderr, "\r[{}{}] {:3.0f} % {:<20.20}", std::string(done, '#'), std::string(kWidth - done, ' '),
             100.0 * fraction, progress.stage());
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
