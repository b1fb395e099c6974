#include "core/network/edge_contacts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "core/base/index.h"
#include "core/network/edge_curves.h"
#include "core/spatial/box_tree.h"

namespace patchmill {
namespace {

// The places do not lie symmetrically, so that no seam of regular parts is met at its end.
constexpr std::array kPlaces = {0.07, 0.28, 0.47, 0.71, 0.94};
constexpr double kReach = 10.0;  // join tolerances
constexpr int kMostTried = 32;   // edges at a place
// Closest points that may be looked for. Hostile models whose open edges pile up reach this limit after some
// seconds; real ones never come near it.
constexpr int kMostFeet = 500'000;
constexpr double kBeside = 1e-3;  // of the parameter: chord that has the direction of the edge
const double kSameDirection = std::cos(Radians(10.0));

Vec3 DirectionAt(const EdgeCurves& curves, int edge, double t) {
  const double from = std::clamp(t - kBeside, 0.0, 1.0), to = std::clamp(t + kBeside, 0.0, 1.0);
  return (curves.Point(edge, to) - curves.Point(edge, from)).normalized();
}

}  // namespace

std::vector<EdgeContact> FindEdgeContacts(const PatchModel& model, const PatchNetwork& network,
                                          const RunContext& run) {
  const EdgeCurves curves(model, run);
  std::vector<int> open;
  std::vector<Box3> boxes;
  for (int e = 0; e < curves.count(); ++e) {
    const EdgeLink& link = network.edges[At(e)];
    if (link.neighbor || link.collapsed) continue;
    open.push_back(e);
    boxes.push_back(curves.box(e));
  }
  const BoxTree tree(std::move(boxes));
  const double reach = kReach * network.join_tolerance;
  std::vector<EdgeContact> contacts;
  int feet = 0;
  for (const int e : open) {
    if (run.Cancelled() || feet > kMostFeet) break;
    for (const double place : kPlaces) {
      const Vec3 p = curves.Point(e, place);
      const Vec3 along = DirectionAt(curves, e, place);
      int tried = 0;
      tree.Near(p, reach, [&](int slot) {
        const int other = open[At(slot)];
        if (curves.edge(other).patch == curves.edge(e).patch) return true;
        ++feet;
        const EdgeFoot foot = ClosestOnEdge(curves, other, p);
        if (foot.distance <= reach && foot.t > 0.0 && foot.t < 1.0) {
          const double cosine = along.dot(DirectionAt(curves, other, foot.t));
          if (std::abs(cosine) >= kSameDirection)
            contacts.push_back({curves.edge(e), curves.edge(other), cosine < 0.0});
        }
        return ++tried < kMostTried;
      });
    }
  }
  const auto order = [](const EdgeContact& a, const EdgeContact& b) {
    return std::tie(a.self, a.other, a.reversed) < std::tie(b.self, b.other, b.reversed);
  };
  std::sort(contacts.begin(), contacts.end(), order);
  const auto same = [&](const EdgeContact& a, const EdgeContact& b) { return !order(a, b) && !order(b, a); };
  contacts.erase(std::unique(contacts.begin(), contacts.end(), same), contacts.end());
  return contacts;
}

}  // namespace patchmill
