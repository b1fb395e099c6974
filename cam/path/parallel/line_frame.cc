#include "cam/path/parallel/line_frame.h"

#include <cmath>

namespace patchmill {

LineFrame LineFrame::At(double angle) {
  LineFrame frame;
  frame.along_ = {std::cos(angle), std::sin(angle)};
  return frame;
}

LineFrame LineFrame::Around(const Vec2& center, double at) {
  LineFrame frame;
  frame.center_ = center;
  frame.at_ = at;
  return frame;
}

Vec2 LineFrame::At(double t, double y) const {
  return round() ? Vec2(center_ + y * Across(t)) : Vec2(t * along_ + y * Across(t));
}

Vec2 LineFrame::Along(double t) const {
  return round() ? Vec2(-std::sin(t / at_), std::cos(t / at_)) : along_;
}

Vec2 LineFrame::Across(double t) const {
  return round() ? Vec2(std::cos(t / at_), std::sin(t / at_)) : Vec2(-along_.y(), along_.x());
}

}  // namespace patchmill
