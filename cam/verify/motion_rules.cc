#include "cam/verify/motion_rules.h"

#include <algorithm>
#include <string>

#include <fmt/format.h>

namespace patchmill {

namespace {

constexpr double kHeightSlack = 1e-4;  // mm; rounding to four decimals

class Rules {
 public:
  Rules(const ProgramMotion& motion, const VerifyParams& params) : motion_(motion), params_(params) {}

  void Ends() {
    const int first = motion_.moves.front().line, last = motion_.moves.back().line;
    if (!motion_.first_motion_is_up)
      Broken("FIRST_MOTION_NOT_UP", "the first motion is not straight up to machine zero", first);
    const ProgramMove& end = motion_.moves.back();
    if (!motion_.last_motion_is_up || (!end.to_above && InStock(end.to)))
      Broken("LAST_MOTION_NOT_UP", "the last motion is not straight up and out of the stock", last);
    if (!motion_.ends_with_spindle_off)
      Broken("SPINDLE_LEFT_ON", "the program ends with the spindle on", last);
    if (!motion_.ends_with_coolant_off)
      Broken("COOLANT_LEFT_ON", "the program ends with the coolant on", last);
  }

  void KnownPlaces() {
    const auto lost = std::find_if(motion_.moves.begin(), motion_.moves.end(), [&](const ProgramMove& m) {
      return m.from_anywhere && ((!m.from_above && InStock(m.from)) || (!m.to_above && InStock(m.to)));
    });
    if (lost == motion_.moves.end()) return;
    Broken("UNKNOWN_START",
           fmt::format("line {}: a move below the stock's top from or to a place in X and Y that the program "
                       "does not state",
                       lost->line),
           lost->line);
  }

  void Spindle() {
    const auto still = std::find_if(motion_.moves.begin(), motion_.moves.end(), [&](const ProgramMove& m) {
      return m.kind == ProgramMove::Kind::kFeed && m.spindle_speed == 0.0F &&
             ((!m.from_above && InStock(m.from)) || (!m.to_above && InStock(m.to)));
    });
    if (still == motion_.moves.end()) return;
    Broken("SPINDLE_STOPPED",
           fmt::format(
               "line {}: a feed below the stock's top with the spindle stopped (M5, M6, or no S above 0)",
               still->line),
           still->line);
  }

  void Floor(const MotionFigures& figures) {
    const double floor = params_.floor_z - params_.program_zero.z();
    if (figures.tip_box.Empty() || figures.tip_box.min.z() >= floor - kHeightSlack) return;
    const double low = figures.tip_box.min.z();
    const auto lowest = std::find_if(motion_.moves.begin(), motion_.moves.end(),
                                     [&](const ProgramMove& m) { return !m.to_above && m.to.z() == low; });
    Broken("BELOW_FLOOR", fmt::format("the tip goes down to Z{:.4f}, below the floor Z{:.4f}", low, floor),
           lowest == motion_.moves.end() ? 0 : lowest->line);
  }

  Diagnostics Take() { return std::move(broken_); }

 private:
  // True if material may be at this tip.
  bool InStock(const Vec3& tip) const {
    return tip.z() + params_.program_zero.z() < params_.stock_top_z - kHeightSlack;
  }
  void Broken(const char* code, std::string message, int line) {
    broken_.push_back(
        MakeError(code, std::move(message), {.line = line > 0 ? std::optional<int>(line) : std::nullopt}));
  }

  const ProgramMotion& motion_;
  const VerifyParams& params_;
  Diagnostics broken_;
};

}  // namespace

Diagnostics BrokenMotionRules(const ProgramMotion& motion, const VerifyParams& params,
                              const MotionFigures& figures) {
  Rules rules(motion, params);
  rules.Ends();
  rules.KnownPlaces();
  rules.Spindle();
  rules.Floor(figures);
  return rules.Take();
}

}  // namespace patchmill
