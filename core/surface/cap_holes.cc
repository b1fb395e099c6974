#include "core/surface/cap_holes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include "core/base/status.h"
#include "core/surface/holes.h"
#include "core/surface/surface.h"

namespace patchmill {
namespace {

constexpr double kMostOffPlane = 0.1;  // share of the hole's diameter that a mouth may lie off its plane
constexpr double kSameCircle =
    1e-3;  // share of the hole's radius that the rim of a chamfer may be off a circle
constexpr double kRounding = 1.0 + 1e-9;  // of diameters
constexpr double kSlack = 1e-6;           // share of the diameter that counts as no way out of a mouth
constexpr int kMostRings = 4;             // chamfers and roundings around a mouth

// Two faces meet along edges of their patches.
struct Joint {
  PatchEdge edge, other;
  FaceId face, other_face;
};

// The joints of each face, seen from it.
using Joints = std::map<FaceId, std::vector<Joint>>;

Joints JointsOf(const PatchNetwork& network) {
  Joints joints;
  const auto add = [&](const PatchEdge& a, const PatchEdge& b) {
    const auto &one = network.model.patches[a.patch.index()].face,
               &two = network.model.patches[b.patch.index()].face;
    if (one && two && one != two) joints[*one].push_back({a, b, *one, *two});
  };
  for (const EdgeLink& link : network.edges) {
    if (link.neighbor && !link.collapsed) add(link.self, *link.neighbor);
  }
  for (const PartLink& link : network.part_links) {
    add(link.part, link.whole);
    add(link.whole, link.part);
  }
  return joints;
}

// A border between the inside of a hole and the outside.
struct Mouth {
  std::vector<Joint> joints;  // seen from the inside
  Vec3 out = Vec3::UnitZ();   // unit vector along the axis, out of the hole
};

struct Inside {
  std::set<FaceId> faces;
  std::vector<Mouth> mouths;
};

class Capper {
 public:
  Capper(const Surface& surface, std::vector<Hole> holes, double diameter)
      : surface_(surface), joints_(JointsOf(surface.network)), holes_(std::move(holes)), diameter_(diameter) {
    for (std::size_t k = 0; k < holes_.size(); ++k) {
      for (const FaceId face : holes_[k].faces) hole_of_[face] = k;
    }
  }

  // What lies behind the mouths of the hole; nullopt if it leads to the outside by another way.
  std::optional<Inside> Enclose(std::size_t hole) const {
    Inside inside;
    std::set<std::size_t> entered;
    std::vector<FaceId> queue;
    const auto enter = [&](FaceId face) {
      if (inside.faces.insert(face).second) queue.push_back(face);
    };
    for (const FaceId face : holes_[hole].faces) enter(face);
    entered.insert(hole);
    while (!queue.empty()) {
      const FaceId face = queue.back();
      queue.pop_back();
      if (const auto bore = hole_of_.find(face); bore != hole_of_.end()) {
        entered.insert(bore->second);
        for (const FaceId other : holes_[bore->second].faces) enter(other);
      }
      for (const Joint& joint : Of(face)) {
        if (!EndOf(joint)) enter(joint.other_face);
      }
    }
    for (const std::size_t k : entered) {
      if (holes_[k].diameter > kRounding * diameter_) return std::nullopt;
      for (const std::size_t end : {0, 1}) {
        if (holes_[k].ends[end] != HoleEnd::kOpen) continue;
        Mouth mouth{RimOf(k, end), OutOf(k, end)};
        const auto behind = [&](const Joint& joint) { return inside.faces.contains(joint.other_face); };
        // The mouth of a narrower hole in the floor of this one lies inside.
        if (k != hole && std::all_of(mouth.joints.begin(), mouth.joints.end(), behind)) continue;
        if (mouth.joints.empty()) continue;  // the border of a sheet
        if (std::any_of(mouth.joints.begin(), mouth.joints.end(), behind)) return std::nullopt;
        inside.mouths.push_back(std::move(mouth));
      }
    }
    if (inside.mouths.empty()) return std::nullopt;
    for (Mouth& mouth : inside.mouths) TakeInRings(holes_[hole], mouth, inside.faces);
    return inside;
  }

 private:
  const std::vector<Joint>& Of(FaceId face) const {
    static const std::vector<Joint> kNone;
    const auto found = joints_.find(face);
    return found == joints_.end() ? kNone : found->second;
  }
  Vec3 Middle(const PatchEdge& edge) const { return PointOf(edge, 0.5); }
  Vec3 PointOf(const PatchEdge& edge, double t) const {
    const PatchShape& shape = surface_.network.model.patches[edge.patch.index()].shape;
    const Vec2 uv = EdgeParameters(shape, edge.edge, t);
    return Evaluate(surface_, edge.patch, uv.x(), uv.y()).p;
  }
  Vec3 OutOf(std::size_t hole, std::size_t end) const {
    return end == 0 ? Vec3(-holes_[hole].direction) : holes_[hole].direction;
  }
  // Index of the hole's end that an edge of its wall is nearer to.
  std::size_t NearerEnd(const Hole& hole, const PatchEdge& edge) const {
    return (Middle(edge) - hole.mouth).dot(hole.direction) > 0.5 * hole.depth ? 1 : 0;
  }
  // The open end of a hole at which a joint of its wall lies.
  std::optional<std::size_t> EndOf(const Joint& joint) const {
    const auto found = hole_of_.find(joint.face);
    if (found == hole_of_.end()) return std::nullopt;
    const Hole& hole = holes_[found->second];
    // Where two holes meet, the joint is the mouth of the narrower one.
    const auto other = hole_of_.find(joint.other_face);
    if (other != hole_of_.end() && holes_[other->second].diameter <= hole.diameter) return std::nullopt;
    const std::size_t end = NearerEnd(hole, joint.edge);
    if (hole.ends[end] != HoleEnd::kOpen) return std::nullopt;
    return end;
  }
  std::vector<Joint> RimOf(std::size_t hole, std::size_t end) const {
    std::vector<Joint> rim;
    for (const FaceId face : holes_[hole].faces) {
      for (const Joint& joint : Of(face)) {
        if (EndOf(joint) == end) rim.push_back(joint);
      }
    }
    return rim;
  }

  // Moves the mouth out over chamfers and roundings: faces, no planes, that have one more border, and
  // this is a circle around the axis that is no wider than `diameter_`.
  void TakeInRings(const Hole& hole, Mouth& mouth, std::set<FaceId>& inside) const {
    for (int ring = 0; ring < kMostRings; ++ring) {
      std::set<FaceId> faces;
      for (const Joint& joint : mouth.joints) faces.insert(joint.other_face);
      std::vector<Joint> border;
      for (const FaceId face : faces) {
        if (surface_.network.model.faces[face.index()].kind == SurfaceKind::kPlane) return;
        for (const Joint& joint : Of(face)) {
          if (!faces.contains(joint.other_face) && !inside.contains(joint.other_face))
            border.push_back(joint);
        }
      }
      if (!IsCircle(hole, border) || !LiesOutside(border, mouth)) return;
      inside.insert(faces.begin(), faces.end());
      mouth.joints = std::move(border);
    }
  }

  // Whether a circle of edges lies farther out along the axis than the mouth. That around the rounded end
  // of a tube does not.
  bool LiesOutside(const std::vector<Joint>& circle, const Mouth& mouth) const {
    const double out = Middle(circle.front().other).dot(mouth.out);
    return std::all_of(mouth.joints.begin(), mouth.joints.end(),
                       [&](const Joint& joint) { return Middle(joint.edge).dot(mouth.out) < out; });
  }

  bool IsCircle(const Hole& hole, const std::vector<Joint>& border) const {
    if (border.empty()) return false;
    const double off = kSameCircle * 0.5 * hole.diameter;
    std::optional<double> height, radius;
    for (const Joint& joint : border) {
      for (const double t : {0.0, 0.5, 1.0}) {
        const Vec3 d = PointOf(joint.other, t) - hole.mouth;
        const double h = d.dot(hole.direction), r = (d - h * hole.direction).norm();
        if (!height) std::tie(height, radius) = std::pair(h, r);
        if (std::abs(h - *height) > off || std::abs(r - *radius) > off) return false;
      }
    }
    return 2.0 * *radius <= kRounding * diameter_;
  }

  const Surface& surface_;
  const Joints joints_;
  const std::vector<Hole> holes_;
  const double diameter_;
  std::map<FaceId, std::size_t> hole_of_;
};

bool IsOn(const PatchShape& shape, int edge, const Vec2& uv) {
  constexpr double kOn = 1e-12;
  if (IsTriangle(shape)) {
    const double off[] = {uv.y(), 1.0 - uv.x() - uv.y(), uv.x()};
    return std::abs(off[edge]) < kOn;
  }
  const double off[] = {uv.y(), 1.0 - uv.x(), 1.0 - uv.y(), uv.x()};
  return std::abs(off[edge]) < kOn;
}

using HomogeneousCurve = std::vector<Vec4>;  // Bezier points (w x, w y, w z, w)

// The points of an edge of a net: 0 v = 0, 1 u = 1, 2 v = 1, 3 u = 0.
HomogeneousCurve BorderOf(const BernsteinNet& net, int edge) {
  HomogeneousCurve curve;
  const int columns = net.degree_v + 1;
  const bool along_u = edge == 0 || edge == 2;
  for (int k = 0; k <= (along_u ? net.degree_u : net.degree_v); ++k) {
    const int i = along_u ? k : edge == 1 ? net.degree_u : 0;
    const int j = along_u ? (edge == 2 ? net.degree_v : 0) : k;
    curve.push_back(net.points[static_cast<std::size_t>(i * columns + j)]);
  }
  return curve;
}

// The curves of a patch's edge, exactly.
std::vector<HomogeneousCurve> CurvesOf(const Surface& surface, const PatchEdge& edge) {
  constexpr std::pair<int, int> kCorners[] = {{0, 1}, {1, 3}, {2, 3}, {0, 2}};  // of Piece::native
  const PatchShape& shape = surface.network.model.patches[edge.patch.index()].shape;
  std::vector<HomogeneousCurve> curves;
  for (std::size_t k = surface.first_piece[edge.patch.index()].index();
       k < surface.pieces.size() && surface.pieces[k].patch == edge.patch; ++k) {
    const Piece& piece = surface.pieces[k];
    for (int side = 0; side < 4; ++side) {
      const auto [from, to] = kCorners[side];
      if (IsOn(shape, edge.edge, piece.native[static_cast<std::size_t>(from)]) &&
          IsOn(shape, edge.edge, piece.native[static_cast<std::size_t>(to)]))
        curves.push_back(BorderOf(piece.net, side));
    }
  }
  return curves;
}

Vec3 PointOf(const Vec4& p) { return p.head<3>() / p.w(); }

struct Cap {
  std::vector<BezierPatch> patches;
  Vec3 middle = Vec3::Zero(), normal = Vec3::UnitZ();  // of the plane nearest to its border; out of the body
  double off_plane = 0.0;                              // mm, by which the border lies off this plane at most
};

// The unit normal of the plane through `middle` that is nearest to the points, on the side of `out`.
Vec3 NormalOf(const std::vector<HomogeneousCurve>& curves, const Vec3& middle, const Vec3& out) {
  Mat3 spread = Mat3::Zero();
  for (const HomogeneousCurve& curve : curves) {
    for (const Vec4& p : curve) spread += (PointOf(p) - middle) * (PointOf(p) - middle).transpose();
  }
  const Vec3 normal = Eigen::SelfAdjointEigenSolver<Mat3>(spread).eigenvectors().col(0);
  return normal.dot(out) < 0.0 ? Vec3(-normal) : normal;
}

// One patch for each curve: `middle` joined to it.
BezierPatch FanPatch(HomogeneousCurve curve, const Vec3& middle, const Vec3& normal) {
  const Vec3 a = PointOf(curve.front()), b = PointOf(curve.back());
  if ((b - a).cross(middle - a).dot(normal) < 0.0) std::reverse(curve.begin(), curve.end());
  BezierPatch patch;
  patch.degree_u = static_cast<int>(curve.size()) - 1;
  patch.degree_v = 1;
  bool rational = false;
  for (const Vec4& p : curve) {
    patch.points.push_back(PointOf(p));
    patch.points.push_back(middle);
    patch.weights.insert(patch.weights.end(), {p.w(), p.w()});
    rational = rational || p.w() != curve.front().w();
  }
  if (!rational) patch.weights.clear();
  return patch;
}

// Whether the curves form closed loops: each end meets one other end.
bool AreClosed(const std::vector<HomogeneousCurve>& curves, double tolerance) {
  std::vector<Vec3> ends;
  for (const HomogeneousCurve& curve : curves) {
    ends.push_back(PointOf(curve.front()));
    ends.push_back(PointOf(curve.back()));
  }
  return !ends.empty() && std::all_of(ends.begin(), ends.end(), [&](const Vec3& end) {
    return std::count_if(ends.begin(), ends.end(),
                         [&](const Vec3& other) { return (other - end).norm() <= tolerance; }) == 2;
  });
}

// The border of a mouth: the edges of the outer faces, to which the cap is joined edge by edge, if they
// close. They may not, because an edge that runs along two others at once has no joint; then those of the
// faces inside. Empty if neither close.
std::vector<HomogeneousCurve> BorderOf(const Surface& surface, const Mouth& mouth) {
  for (const auto side : {&Joint::other, &Joint::edge}) {
    std::set<PatchEdge> edges;  // several joints may share one
    for (const Joint& joint : mouth.joints) edges.insert(joint.*side);
    std::vector<HomogeneousCurve> curves;
    for (const PatchEdge& edge : edges) {
      for (HomogeneousCurve& curve : CurvesOf(surface, edge)) curves.push_back(std::move(curve));
    }
    if (AreClosed(curves, 2.0 * surface.network.join_tolerance)) return curves;
  }
  return {};
}

// nullopt for a border that is no closed curve with positive weights.
std::optional<Cap> CapOf(const Surface& surface, const Mouth& mouth) {
  const std::vector<HomogeneousCurve> curves = BorderOf(surface, mouth);
  Cap cap;
  double all = 0.0;
  for (const HomogeneousCurve& curve : curves) {
    if (std::any_of(curve.begin(), curve.end(), [](const Vec4& p) { return !(p.w() > 0.0); }))
      return std::nullopt;
    const Vec3 a = PointOf(curve.front()), b = PointOf(curve.back());
    cap.middle += (a - b).norm() * 0.5 * (a + b);
    all += (a - b).norm();
  }
  if (!(all > 0.0)) return std::nullopt;
  cap.middle /= all;
  cap.normal = NormalOf(curves, cap.middle, mouth.out);
  for (const HomogeneousCurve& curve : curves) {
    for (const Vec4& p : curve)
      cap.off_plane = std::max(cap.off_plane, std::abs((PointOf(p) - cap.middle).dot(cap.normal)));
    cap.patches.push_back(FanPatch(curve, cap.middle, cap.normal));
  }
  return cap;
}

// Whether a face behind a cap stands out of its mouth. Control points decide: they may lie a little beyond.
bool StandsOut(const Surface& surface, const std::set<FaceId>& inside, const Cap& cap, double slack) {
  return std::any_of(surface.pieces.begin(), surface.pieces.end(), [&](const Piece& piece) {
    const auto& face = surface.network.model.patches[piece.patch.index()].face;
    if (!face || !inside.contains(*face)) return false;
    return std::any_of(piece.net.points.begin(), piece.net.points.end(), [&](const Vec4& p) {
      return p.w() > 0.0 && (PointOf(p) - cap.middle).dot(cap.normal) > slack;
    });
  });
}

std::string FreeId(const PatchModel& model, int number) {
  for (;; ++number) {
    std::string id = fmt::format("cap{}", number);
    const bool taken =
        std::any_of(model.faces.begin(), model.faces.end(), [&](const ModelFace& f) { return f.id == id; }) ||
        std::any_of(model.patches.begin(), model.patches.end(), [&](const Patch& p) { return p.id == id; });
    if (!taken) return id;
  }
}

// Takes faces out of the model with all their patches.
void RemoveFaces(const std::set<FaceId>& removed, PatchModel& model) {
  std::erase_if(model.patches,
                [&](const Patch& patch) { return patch.face && removed.contains(*patch.face); });
  std::vector<FaceId> renumbered;
  std::vector<ModelFace> kept;
  for (std::size_t f = 0; f < model.faces.size(); ++f) {
    renumbered.emplace_back(kept.size());
    if (!removed.contains(FaceId(f))) kept.push_back(std::move(model.faces[f]));
  }
  model.faces = std::move(kept);
  for (Patch& patch : model.patches) {
    if (patch.face) patch.face = renumbered[patch.face->index()];
  }
}

}  // namespace

absl::StatusOr<CappedModel> CapHoles(PatchModel model, const CapParams& params, const RunContext& run) {
  CappedModel result{std::move(model), {}};
  if (result.model.faces.empty()) {
    result.findings.push_back(MakeWarning(
        "HOLES_CAPPED", "no hole is closed: the model has no faces, and holes are found by their faces"));
    return result;
  }
  const double diameter = params.diameter / params.scale;
  PM_ASSIGN_OR_RETURN(PatchNetwork network, BuildNetwork(result.model, run));
  PM_ASSIGN_OR_RETURN(const Surface surface, BuildSurface(std::move(network), SurfaceParams{}, run));
  PM_ASSIGN_OR_RETURN(const std::vector<Hole> holes, FindHoles(surface, run));
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < holes.size(); ++k) {
    if (holes[k].diameter <= kRounding * diameter) order.push_back(k);
  }
  // A wide hole takes narrower ones in its floor with it.
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return holes[a].diameter > holes[b].diameter; });
  const Capper capper(surface, holes, diameter);
  std::set<FaceId> removed;
  int caps = 0;
  std::vector<std::string> capped;
  const auto title = [&](const Hole& hole) {
    return fmt::format("{} (diameter {:.6g} mm)",
                       Title(surface.network.model.faces[hole.faces.front().index()]),
                       params.scale * hole.diameter);
  };
  const auto refuse = [&](const Hole& hole, std::string_view why) {
    Where where;
    where.face_id = surface.network.model.faces[hole.faces.front().index()].id;
    where.point = hole.mouth;
    result.findings.push_back(MakeWarning(
        "HOLE_NOT_CAPPED", fmt::format("hole {} stays open: {}", title(hole), why), std::move(where)));
  };
  for (const std::size_t k : order) {
    PM_RETURN_IF_ERROR(run.Check());
    const Hole& hole = holes[k];
    if (removed.contains(hole.faces.front())) continue;
    const std::optional<Inside> inside = capper.Enclose(k);
    if (!inside) {
      refuse(hole, "its inside leads to the outside by another way than its mouths");
      continue;
    }
    std::vector<Cap> made;
    bool stands_out = false, rim_is_closed = true;
    for (const Mouth& mouth : inside->mouths) {
      std::optional<Cap> cap = CapOf(surface, mouth);
      if (!cap) rim_is_closed = false;
      if (!cap || cap->off_plane > kMostOffPlane * hole.diameter) break;
      stands_out =
          stands_out || StandsOut(surface, inside->faces, *cap, cap->off_plane + kSlack * hole.diameter);
      made.push_back(*std::move(cap));
    }
    if (!rim_is_closed) {
      refuse(hole, "the edges around a mouth do not close");
      continue;
    }
    if (made.size() < inside->mouths.size()) {
      refuse(hole, fmt::format("a mouth lies off its plane by more than {:.4g} mm",
                               params.scale * kMostOffPlane * hole.diameter));
      continue;
    }
    if (stands_out) {
      refuse(hole, "what is inside stands out of a mouth");
      continue;
    }
    const ModelFace wall = surface.network.model.faces[hole.faces.front().index()];
    for (Cap& cap : made) {
      ModelFace face;
      face.id = FreeId(result.model, ++caps);
      face.name = "cap of " + wall.id;
      face.body = wall.body;
      face.kind = cap.off_plane <= 1e-9 * hole.diameter ? SurfaceKind::kPlane : SurfaceKind::kSpline;
      for (BezierPatch& patch : cap.patches)
        result.model.patches.push_back({"", std::move(patch), FaceId(result.model.faces.size())});
      result.model.faces.push_back(std::move(face));
    }
    removed.insert(inside->faces.begin(), inside->faces.end());
    capped.push_back(title(hole));
  }
  RemoveFaces(removed, result.model);
  constexpr std::size_t kNamed = 5;
  std::string names;
  for (std::size_t k = 0; k < std::min(kNamed, capped.size()); ++k)
    names += (k > 0 ? ", " : ": ") + capped[k];
  if (capped.size() > kNamed) names += fmt::format(" and {} more", capped.size() - kNamed);
  result.findings.insert(
      result.findings.begin(),
      MakeInfo("HOLES_CAPPED", fmt::format("{} hole{} of at most {:.6g} mm closed by {} cap{}{}",
                                           capped.size(), capped.size() == 1 ? "" : "s", params.diameter,
                                           caps, caps == 1 ? "" : "s", names)));
  return result;
}

}  // namespace patchmill
