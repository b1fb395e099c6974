// A progress bar on a terminal. In a pipe nothing is shown.
#pragma once

#include <string>

#include "patchmill/v1/report.pb.h"

namespace patchmill::cli {

class ProgressBar {
 public:
  explicit ProgressBar(bool quiet);  // shown on stderr when that is a terminal
  ~ProgressBar() { Clear(); }
  void Show(const v1::Progress& progress);
  void Clear();

 private:
  bool shown_ = false, wanted_ = false;
};

}  // namespace patchmill::cli
