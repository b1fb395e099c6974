#include "core/joining/face_frame.h"

#include <algorithm>

#include "core/base/index.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

FaceFrame::Cubic Turned(FaceFrame::Cubic cubic) {
  std::ranges::reverse(cubic);
  return cubic;
}

}  // namespace

FaceFrame FrameOf(const CurvedNetwork& curved, const FaceSide& side, bool from_first) {
  const auto cubic = [&](int k) {  // the side k of the face, in its own direction
    const FaceSide at{side.face, k % 4};
    const BezierChain& chain = curved.edges[At(curved.table.face_edges[At(at.face)][At(at.side)])].curve;
    PM_CHECK(chain.degree == 3 && chain.spans() == 1);
    FaceFrame::Cubic points;
    std::copy(chain.points.begin(), chain.points.end(), points.begin());
    return curved.table.Forward(at, curved.network) ? points : Turned(points);
  };
  const int s = side.side;
  const FaceFrame frame{side.face,           s,        (s + 1) % 4,          (s + 3) % 4,
                        (s + 2) % 4,         cubic(s), Turned(cubic(s + 3)), cubic(s + 1),
                        Turned(cubic(s + 2))};
  return from_first ? frame : FromOtherEnd(frame);
}

std::array<FaceFrame, 2> FramesAt(const CurvedNetwork& curved, const TableEdge& edge, int end) {
  std::array<FaceFrame, 2> frames;
  for (const std::size_t k : {0, 1}) {
    const bool forward = curved.table.Forward(edge.faces[k], curved.network);
    frames[k] = FrameOf(curved, edge.faces[k], forward == (end == 0));
  }
  return frames;
}

FaceFrame FromOtherEnd(const FaceFrame& f) {
  return {f.face, f.b, f.a, f.d, f.c, Turned(f.ab), f.bd, f.ac, Turned(f.cd)};
}

FaceFrame FromOtherSide(const FaceFrame& f) {
  return {f.face, f.c, f.d, f.a, f.b, f.cd, Turned(f.ac), Turned(f.bd), f.ab};
}

Vec3 FirstAtStart(const FaceFrame::Cubic& c) { return 3.0 * (c[1] - c[0]); }
Vec3 SecondAtStart(const FaceFrame::Cubic& c) { return 6.0 * (c[2] - 2.0 * c[1] + c[0]); }
Vec3 ThirdAtStart(const FaceFrame::Cubic& c) { return 6.0 * (c[3] - 3.0 * (c[2] - c[1]) - c[0]); }

TwistForm operator+(const TwistForm& x, const TwistForm& y) {
  TwistForm sum{x.constant + y.constant, {}};
  for (int k = 0; k < 4; ++k) sum.factor[At(k)] = x.factor[At(k)] + y.factor[At(k)];
  return sum;
}
TwistForm operator-(const TwistForm& x, const TwistForm& y) { return x + (-1.0) * y; }
TwistForm operator*(double s, const TwistForm& x) {
  TwistForm product{s * x.constant, {}};
  for (int k = 0; k < 4; ++k) product.factor[At(k)] = s * x.factor[At(k)];
  return product;
}

TwistForm Mixed11(const FaceFrame& frame) {
  TwistForm form;
  form.factor[At(frame.a)] = 1.0;
  return form;
}

// Along ac, S_t is a cubic in n. Its ends are the tangents at a and c, its end derivatives the twists. At c
// the side ac arrives, so S_tn is the twist with the opposite sign.
TwistForm Mixed12(const FaceFrame& frame) {
  TwistForm form;
  form.constant = 6.0 * (FirstAtStart(frame.cd) - FirstAtStart(frame.ab));
  form.factor[At(frame.a)] = -4.0;
  form.factor[At(frame.c)] = 2.0;
  return form;
}
TwistForm Mixed13(const FaceFrame& frame) {
  TwistForm form;
  form.constant = 12.0 * (FirstAtStart(frame.ab) - FirstAtStart(frame.cd));
  form.factor[At(frame.a)] = 6.0;
  form.factor[At(frame.c)] = -6.0;
  return form;
}

// Along ab, S_nn is a cubic in t. At b the parameter t arrives.
TwistForm Mixed22(const FaceFrame& frame) {
  TwistForm ends;
  ends.constant = 6.0 * (SecondAtStart(frame.bd) - SecondAtStart(frame.ac));
  return ends - 4.0 * Mixed12(frame) + 2.0 * Mixed12(FromOtherEnd(frame));
}

}  // namespace patchmill
