// h by triangles, as other software finds it, to check cam/location. A ball comes down on a fine tessellation
// in the AABB tree of CGAL. It shares no code with cam/location: patches in their native form, no pieces, no
// bounds, no derivatives.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "core/network/patch_model.h"

namespace patchmill::testing {

struct MeshParams {
  double error = 0.002;  // mm: between triangles and surface, either way (see below)
  // Only what balls can touch whose centres lie in this plan box, widened by `reach`; everything when empty.
  std::optional<std::pair<Vec2, Vec2>> window;
  double reach = 0.0;  // mm
};

class MeshOracle {
 public:
  // Parameter rectangles are divided until the surface keeps to `error` / 2 of their two triangles at 16
  // places, parameter by parameter. What the samples miss of smooth patches is far below the other half.
  // Thus every point of the surface has one of a triangle within `error`, and the other way round, so that
  //   h_{R - error}(surface) <= h_R(triangles) <= h_{R + error}(surface).
  MeshOracle(const PatchModel& model, const MeshParams& params);
  ~MeshOracle();

  // h of the triangles lies between; high - low <= `within` (mm), or a little more where the ball touches
  // nearly with its equator and comes down slowly.
  struct Bracket {
    double low = -kInfinity, high = kInfinity;
  };
  std::optional<Bracket> Height(const Vec2& q, double radius, double within) const;

  std::size_t triangle_count() const;

 private:
  struct Mesh;
  std::unique_ptr<Mesh> mesh_;
};

}  // namespace patchmill::testing
