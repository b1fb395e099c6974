// How the four sides of every piece of a surface continue: smoothly, over a crease, or not at all.
//
// A contact on a side that is not smooth is a contact with a curve, not with a tangent plane. The search for
// contours needs to know this, and so does the question which part of a contour is a pass.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "core/base/run_context.h"
#include "core/surface/surface.h"

namespace patchmill {

// Sides of a piece, in its own parameters: 0: v=0, 1: u=1, 2: v=1, 3: u=0. Sides 0 and 2 run along u, 1 and 3
// along v.
enum class SideKind { kSmooth, kCrease, kOpen };

struct PieceSide {
  SideKind kind = SideKind::kOpen;
  double angle = 0.0;  // rad, kSmooth: largest angle between the tangent planes found along it
  double step = 0.0;   // mm, kSmooth: largest gap to the neighbour found along it
};

// rad: a side counts as smooth if the surface continues across it within this angle, at the samples.
inline constexpr double kSmoothSideAngle = 0.03;

// The sides of all pieces. Joints between patches come from the network, T-junctions included; joints between
// the pieces of one patch come from their common corners. Collapsed sides are kOpen (they are points).
class PieceSides {
 public:
  // Keeps a reference. Cost O(n log n), in parallel. Unusable if the run was cancelled meanwhile.
  PieceSides(const Surface& surface, const RunContext& run);

  const PieceSide& At(PieceId piece, int side) const {
    return sides_[piece.index()][static_cast<std::size_t>(side)];
  }
  // Returns the same place on the piece across side `side`, at parameter t in [0,1] of that side; nullopt at
  // open sides.
  std::optional<SurfacePoint> Across(PieceId piece, int side, double t) const;

 private:
  struct EdgePart {  // a side of a piece on an edge of its patch, from t = t0 to t1 of that edge
    PieceId piece;
    int side = 0;
    double t0 = 0.0, t1 = 1.0;
  };
  using Place = std::tuple<std::int32_t, std::int64_t, std::int64_t>;  // patch, middle of a side in native
                                                                       // parameters
  Place MiddleOf(PieceId piece, int side) const;
  struct SidePoint {
    SurfacePoint at;
    int side = 0;
  };
  std::optional<SidePoint> OnEdge(PatchEdge edge, double t) const;
  std::optional<SidePoint> AcrossJunction(PatchEdge edge, double t) const;
  std::optional<SidePoint> Beyond(PieceId piece, int side, double t) const;  // as Across, with the side there
  std::optional<PieceSide> TurnAt(PieceId piece, int side, double t) const;
  PieceSide Classify(PieceId piece, int side) const;

  const Surface* surface_;
  std::map<PatchEdge, std::vector<EdgePart>> edges_;
  std::map<PatchEdge, std::vector<PartLink>> junctions_;  // under both edges of a part
  std::map<Place, std::vector<std::pair<PieceId, int>>> inner_;
  std::vector<std::array<PieceSide, 4>> sides_;
};

// Parameters (u,v) of the point t of a side.
Vec2 SideParameters(int side, double t);

// Returns the unit vector in the tangent plane at a point of the side that is square to the side and points
// out of the piece; nullopt where the parametrisation is degenerate.
std::optional<Vec3> OutwardTangent(const Surface& surface, PieceId piece, int side, double t);

}  // namespace patchmill
