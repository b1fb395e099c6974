#include "cam/verify/join_reports.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "core/base/status.h"

namespace patchmill {
namespace {

// True if `a` leaves less than `b`.
bool LeavesLess(const VerifyReport& a, const VerifyReport& b) {
  if (a.finish_ok != b.finish_ok) return a.finish_ok;
  return a.max_leftover < b.max_leftover;
}

std::size_t PartOfFinish(const std::vector<PartReport>& parts, PartsOfProgram kind) {
  std::size_t best = 0;
  for (std::size_t k = 1; k < parts.size(); ++k) {
    const bool less = LeavesLess(parts[k].report, parts[best].report);
    const bool more = LeavesLess(parts[best].report, parts[k].report);
    if (kind == PartsOfProgram::kTools ? less : more) best = k;
  }
  return best;
}

void JoinFigures(const VerifyReport& other, PartsOfProgram kind, VerifyReport& joined) {
  joined.gouge_ok = joined.gouge_ok && other.gouge_ok;
  joined.motion_ok = joined.motion_ok && other.motion_ok;
  if (other.holder_ok) joined.holder_ok = joined.holder_ok.value_or(true) && *other.holder_ok;
  if (other.max_gouge > joined.max_gouge) {
    joined.max_gouge = other.max_gouge;
    joined.max_gouge_at = other.max_gouge_at;
  }
  joined.required_stickout = std::max(joined.required_stickout, other.required_stickout);
  joined.steepest_descent = std::max(joined.steepest_descent, other.steepest_descent);
  if (!other.tip_box.Empty()) {
    joined.tip_z_min = joined.tip_box.Empty() ? other.tip_z_min : std::min(joined.tip_z_min, other.tip_z_min);
    joined.tip_box.Add(other.tip_box);
  }
  const auto join = [&](double a, double b) {
    return kind == PartsOfProgram::kTools ? a + b : std::max(a, b);
  };
  joined.cut_length = join(joined.cut_length, other.cut_length);
  joined.rapid_length = join(joined.rapid_length, other.rapid_length);
}

// The findings of all parts, each once, in the order of the parts.
Diagnostics JoinFindings(const std::vector<PartReport>& parts, std::size_t finish, PartsOfProgram kind) {
  const auto counts = [&](std::size_t k, const Diagnostic& finding) {
    return kind == PartsOfProgram::kWays || k == finish || finding.code != "LEFTOVER";
  };
  std::map<std::pair<std::string, std::string>, std::vector<std::size_t>> parts_of;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    for (const Diagnostic& finding : parts[k].report.findings) {
      std::vector<std::size_t>& in = parts_of[{finding.code, finding.message}];
      if (in.empty() || in.back() != k) in.push_back(k);
    }
  }
  Diagnostics joined;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    for (const Diagnostic& finding : parts[k].report.findings) {
      const std::vector<std::size_t>& in = parts_of[{finding.code, finding.message}];
      if (in.front() != k || !counts(k, finding)) continue;
      joined.push_back(finding);
      const bool of_finish = kind == PartsOfProgram::kTools && finding.code == "LEFTOVER";
      if (in.size() == parts.size() || of_finish) continue;
      std::string names;
      for (const std::size_t i : in) names += (names.empty() ? "" : ", ") + parts[i].name;
      joined.back().message += fmt::format(" ({})", names);
    }
  }
  return joined;
}

}  // namespace

VerifyReport JoinReports(std::vector<PartReport> parts, PartsOfProgram kind) {
  PM_CHECK(!parts.empty());
  const std::size_t finish = PartOfFinish(parts, kind);
  if (parts.size() == 1) return std::move(parts.front().report);
  Diagnostics findings = JoinFindings(parts, finish, kind);
  VerifyReport joined = parts[finish].report;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (k != finish) JoinFigures(parts[k].report, kind, joined);
  }
  if (kind == PartsOfProgram::kTools) {
    findings.push_back(
        MakeInfo("FINISH_OF_TOOL",
                 fmt::format("the finish is that of {}; what other tools take in addition is not counted",
                             parts[finish].name)));
  }
  joined.findings = std::move(findings);
  return joined;
}

}  // namespace patchmill
