// The edges of all patches as sampled curves, and the closest point on one.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/base/run_context.h"
#include "core/network/patch_network.h"

namespace patchmill {

// Points of every edge at equal steps of its parameter, both ends included. There are at least 8 steps, more
// for high degrees and many knots.
class EdgeCurves {
 public:
  EdgeCurves(const PatchModel& model, const RunContext& run);

  int count() const { return static_cast<int>(edges_.size()); }
  PatchEdge edge(int e) const { return edges_[static_cast<std::size_t>(e)]; }
  const PatchShape& shape(int e) const { return model_->patches[edge(e).patch.index()].shape; }
  std::span<const Vec3> samples(int e) const;
  const Vec3& start(int e) const { return samples(e).front(); }
  const Vec3& end(int e) const { return samples(e).back(); }
  double length(int e) const;  // of the sampled polyline
  double reach(int e) const;   // largest distance of a sample from the start
  Box3 box(int e) const;       // of the samples, grown by how far the curve may leave them
  Vec3 Point(int e, double t) const;
  const std::vector<int>& first_edge() const { return first_edge_; }  // of each patch

 private:
  const PatchModel* model_;
  std::vector<PatchEdge> edges_;
  std::vector<int> first_edge_;
  std::vector<std::size_t> first_sample_;
  std::vector<Vec3> samples_;
};

struct EdgeFoot {
  double t = 0.0;
  double distance = 0.0;
};
// The point of edge `e` closest to `p`. It starts at the nearest stretch between samples and continues by
// Gauss-Newton (quadratic when p lies on the edge), or by golden section where the edge's derivative
// vanishes.
EdgeFoot ClosestOnEdge(const EdgeCurves& curves, int e, const Vec3& p);

// Whether EdgeDistance is within `tolerance`. It is quicker: points of equal parameter decide where they lie
// close enough.
bool EdgesAgree(const EdgeCurves& curves, int a, int b, bool reversed, double tolerance);

// Largest distance from a sample of either edge to the other one. `limit` ends the search early: any result
// above it only says "more than limit". `reversed`: the parameters run in opposite directions. Where points
// of equal parameter are closer than a tenth of `limit`, their distance is taken as it is (an upper bound).
double EdgeDistance(const EdgeCurves& curves, int a, int b, bool reversed, double limit);

}  // namespace patchmill
