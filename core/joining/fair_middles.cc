#include "core/joining/fair_middles.h"

#include <algorithm>

#include "core/base/index.h"
#include "core/joining/fair_joints.h"
#include "core/joining/fair_twists.h"

namespace patchmill {
namespace {

// The value of a form of a face at the estimated twists.
Vec3 ValueOf(const TwistForm& form, const std::array<Vec3, 4>& twists) {
  Vec3 sum = form.constant;
  for (std::size_t c = 0; c < 4; ++c) sum += form.factor[c] * twists[c];
  return sum;
}

// [joining (29)]
CrossEnd MiddleOf(const FaceFrame& a, const std::array<Vec3, 4>& twists) {
  const FaceFrame b = FromOtherEnd(a);
  return {
      0.5 * (FirstAtStart(a.ac) + FirstAtStart(b.ac)) + 0.125 * ValueOf(Mixed11(a) + Mixed11(b), twists),
      0.5 * (SecondAtStart(a.ac) + SecondAtStart(b.ac)) + 0.125 * ValueOf(Mixed12(a) + Mixed12(b), twists)};
}

// The part of a cubic spline's second derivative at a knot that its third derivative tells to be missing, in
// the parameter of the first face [joining (36)].
Vec3 MissingBend(const std::array<JointEnd, 2>& ends, const std::array<Vec3, 2>& third_slopes) {
  const double k = 0.5 * (ends[0].ratio + ends[1].ratio);
  const Vec3 third = 0.5 * (ends[0].third + ends[1].third) + 0.125 * (third_slopes[0] + third_slopes[1]);
  return (1.0 - k + k * k) / (6.0 * (1.0 + k) * k * k * k) * third;
}

}  // namespace

FairMiddles EstimateMiddles(const CurvedNetwork& curved) {
  FairMiddles middles(curved.edges.size());
  const FairJoints joints = FindFairJoints(curved);
  const auto twists = EstimateTwists(curved, joints);
  if (!twists) return middles;
  for (std::size_t e = 0; e < curved.edges.size(); ++e) {
    const TableEdge& edge = curved.table.edges[e];
    const auto in = [&](const FaceSide& side) { return joints.faces[At(side.face)]; };
    for (std::size_t k = 0; k < edge.faces.size() && k < 2; ++k) {
      const FaceSide& side = edge.faces[k];
      const bool crease = curved.edges[e].kind == EdgeKind::kCrease;
      if (!in(side) || !(crease || std::ranges::all_of(edge.faces, in))) continue;
      middles[e][k] = MiddleOf(FrameOf(curved, side, true), (*twists)[At(side.face)]);
    }
    if (!joints.ends[e]) continue;
    std::array<Vec3, 2> third_slopes;
    for (const int end : {0, 1}) {
      const auto frames = FramesAt(curved, edge, end);
      const JointEnd& joint = (*joints.ends[e])[At(end)];
      const double k = joint.ratio;
      third_slopes[At(end)] = ValueOf(Mixed13(frames[1]), (*twists)[At(frames[1].face)]) +
                              k * k *
                                  (k * ValueOf(Mixed13(frames[0]), (*twists)[At(frames[0].face)]) +
                                   3.0 * joint.ratio_slope * ThirdAtStart(frames[0].ac));
    }
    const Vec3 missing = MissingBend(*joints.ends[e], third_slopes);
    const double k = 0.5 * ((*joints.ends[e])[0].ratio + (*joints.ends[e])[1].ratio);
    middles[e][0]->dd += missing;
    middles[e][1]->dd += k * k * missing;
  }
  return middles;
}

}  // namespace patchmill
