#include "core/joining/fair_twists.h"

#include <cmath>
#include <initializer_list>
#include <utility>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include "core/base/index.h"

namespace patchmill {
namespace {

// The weight of the faces' terms [joining (34)]. It is small: they decide what the jumps leave open, and a
// bicubic surface is still found to 1e-8 of its size.
constexpr double kFaceWeight = 3e-3;
// Where the crossing curves' third derivatives jump by this share of their first ones, the jumps of the
// surface's third derivatives count half [joining (33)].
constexpr double kHalfTrust = 0.05;

// The twist at a corner is factor * unknown + constant. Corners that joints connect share an unknown.
struct CornerTwist {
  int unknown = -1;
  double factor = 1.0;
  Vec3 constant = Vec3::Zero();
};
using CornerTwists = std::vector<std::array<CornerTwist, 4>>;

// The twist at the corner across a joint is factor * (twist at this corner) + constant.
struct Link {
  int face = 0, corner = 0;
  double factor = 1.0;
  Vec3 constant = Vec3::Zero();
};
using Links = std::vector<std::array<std::vector<Link>, 4>>;

Links LinksOf(const CurvedNetwork& curved, const FairJoints& joints) {
  Links links(joints.faces.size());
  for (std::size_t e = 0; e < joints.ends.size(); ++e) {
    if (!joints.ends[e]) continue;
    for (const int end : {0, 1}) {
      const auto frames = FramesAt(curved, curved.table.edges[e], end);
      const FaceFrame &f = frames[0], &g = frames[1];
      const JointEnd& joint = (*joints.ends[e])[At(end)];
      const Vec3 turn = -joint.ratio_slope * FirstAtStart(f.ac);  // [joining (31)]
      links[At(f.face)][At(f.a)].push_back({g.face, g.a, -joint.ratio, turn});
      links[At(g.face)][At(g.a)].push_back({f.face, f.a, -1.0 / joint.ratio, Vec3(turn / joint.ratio)});
    }
  }
  return links;
}

// Numbers the unknowns. Returns their count.
int NumberTwists(const Links& links, const std::vector<bool>& faces, CornerTwists& twists) {
  int count = 0;
  std::vector<std::pair<int, int>> open;
  for (int f = 0; f < static_cast<int>(faces.size()); ++f) {
    for (int c = 0; faces[At(f)] && c < 4; ++c) {
      if (twists[At(f)][At(c)].unknown >= 0) continue;
      twists[At(f)][At(c)].unknown = count;
      open = {{f, c}};
      while (!open.empty()) {
        const auto [face, corner] = open.back();
        open.pop_back();
        const CornerTwist from = twists[At(face)][At(corner)];
        for (const Link& link : links[At(face)][At(corner)]) {
          CornerTwist& to = twists[At(link.face)][At(link.corner)];
          if (to.unknown >= 0) continue;
          to = {count, link.factor * from.factor, link.factor * from.constant + link.constant};
          open.emplace_back(link.face, link.corner);
        }
      }
      ++count;
    }
  }
  return count;
}

using Sparse = Eigen::SparseMatrix<double>;

// The terms of the least-squares problem.
class Terms {
 public:
  explicit Terms(const CornerTwists& twists) : twists_(twists) {}

  // Adds the square of weight * (constant + sum of the forms), each of a face.
  void Add(double weight, Vec3 constant, std::initializer_list<std::pair<int, TwistForm>> forms) {
    const int row = static_cast<int>(right_.size());
    for (const auto& [face, form] : forms) {
      constant += form.constant;
      for (int c = 0; c < 4; ++c) {
        const double factor = form.factor[At(c)];
        if (factor == 0.0) continue;
        const CornerTwist& twist = twists_[At(face)][At(c)];
        entries_.emplace_back(row, twist.unknown, weight * factor * twist.factor);
        constant += factor * twist.constant;
      }
    }
    right_.push_back(-weight * constant);
  }

  // [joining (32), (33)]
  void AddJoint(const std::array<FaceFrame, 2>& frames, const JointEnd& end) {
    const FaceFrame &f = frames[0], &g = frames[1];
    const double k = end.ratio, k2 = k * k, k3 = k2 * k;
    Add(1.0 / k, -end.second_slope - 2.0 * k * end.ratio_slope * SecondAtStart(f.ac),
        {{g.face, Mixed12(g)}, {f.face, -k2 * Mixed12(f)}});
    const double size = k * FirstAtStart(g.ac).norm() + k3 * FirstAtStart(f.ac).norm();
    const double trust = kHalfTrust / (kHalfTrust + end.third.norm() / size);
    Add(trust / std::sqrt(k3), -end.third_slope + 3.0 * k2 * end.ratio_slope * ThirdAtStart(f.ac),
        {{g.face, Mixed13(g)}, {f.face, k3 * Mixed13(f)}});
  }

  // The integral of S_uuvv^2 by Gauss's rule of 2 x 2 places, which is exact for it.
  void AddFace(const FaceFrame& frame) {
    const FaceFrame opposite = FromOtherSide(frame);
    const TwistForm corner[4] = {Mixed22(frame), Mixed22(FromOtherEnd(frame)), Mixed22(opposite),
                                 Mixed22(FromOtherEnd(opposite))};
    const double place = 0.5 - 0.5 / std::sqrt(3.0);
    for (const double x : {place, 1.0 - place}) {
      for (const double y : {place, 1.0 - place}) {
        Add(0.5 * kFaceWeight, Vec3::Zero(),
            {{frame.face, (1.0 - y) * ((1.0 - x) * corner[0] + x * corner[1]) +
                              y * ((1.0 - x) * corner[2] + x * corner[3])}});
      }
    }
  }

  std::optional<Eigen::MatrixX3d> Minimum(int unknowns) const {
    Sparse rows(static_cast<Eigen::Index>(right_.size()), unknowns);
    rows.setFromTriplets(entries_.begin(), entries_.end());
    Eigen::MatrixX3d right(rows.rows(), 3);
    for (Eigen::Index i = 0; i < rows.rows(); ++i) right.row(i) = right_[static_cast<std::size_t>(i)];
    const Eigen::SimplicialLDLT<Sparse> factor(Sparse(rows.transpose() * rows));
    if (factor.info() != Eigen::Success) return std::nullopt;
    Eigen::MatrixX3d x = factor.solve(rows.transpose() * right);
    if (!x.allFinite()) return std::nullopt;
    return x;
  }

 private:
  const CornerTwists& twists_;
  std::vector<Eigen::Triplet<double>> entries_;
  std::vector<Vec3> right_;
};

}  // namespace

std::optional<FaceTwists> EstimateTwists(const CurvedNetwork& curved, const FairJoints& joints) {
  CornerTwists twists(joints.faces.size());
  const int unknowns = NumberTwists(LinksOf(curved, joints), joints.faces, twists);
  if (unknowns == 0) return std::nullopt;
  Terms terms(twists);
  for (std::size_t e = 0; e < joints.ends.size(); ++e) {
    if (!joints.ends[e]) continue;
    for (const int end : {0, 1}) {
      terms.AddJoint(FramesAt(curved, curved.table.edges[e], end), (*joints.ends[e])[At(end)]);
    }
  }
  for (int f = 0; f < static_cast<int>(joints.faces.size()); ++f) {
    if (joints.faces[At(f)]) terms.AddFace(FrameOf(curved, {f, 0}, true));
  }
  const auto solved = terms.Minimum(unknowns);
  if (!solved) return std::nullopt;
  FaceTwists found(joints.faces.size());
  for (std::size_t f = 0; f < found.size(); ++f) {
    for (std::size_t c = 0; c < 4; ++c) {
      const CornerTwist& twist = twists[f][c];
      found[f][c] = Vec3::Zero();
      if (twist.unknown < 0) continue;
      found[f][c] = twist.factor * solved->row(twist.unknown).transpose() + twist.constant;
    }
  }
  return found;
}

}  // namespace patchmill
