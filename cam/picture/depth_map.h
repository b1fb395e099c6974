// The depth of a view: how near to the eye the surface is at each dot. It decides what is hidden.
#pragma once

#include <vector>

#include "cam/picture/view.h"
#include "core/surface/surface.h"

namespace patchmill {

// The part of the picture that a depth map covers, in px.
struct DepthFrame {
  Vec2 corner = Vec2::Zero();
  double width = 0.0, height = 0.0;
  double dot = 1.0;  // > 0, side of a dot
};

class DepthMap {
 public:
  // Covers the frame with dots. The surface is approximated by `cells` x `cells` facets per piece.
  DepthMap(const Surface& surface, const View& view, const DepthFrame& frame, int cells);

  // True if no part of the surface is nearer to the eye than p by more than `slack` (mm), except for the
  // depth that changes within about a dot around p.
  bool Visible(const Vec3& p, double slack) const;

 private:
  double& At(int i, int j) { return near_[static_cast<std::size_t>(j * columns_ + i)]; }
  double At(int i, int j) const { return near_[static_cast<std::size_t>(j * columns_ + i)]; }
  Vec2 ToDots(const Vec3& p) const { return (view_(p) - corner_) / dot_; }
  void Fill(const Vec3& a, const Vec3& b, const Vec3& c);

  View view_;
  Vec2 corner_;
  double dot_;
  int columns_, rows_;
  std::vector<double> near_;
};

}  // namespace patchmill
