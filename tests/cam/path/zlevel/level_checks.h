// What every level of contours must satisfy, judged by h alone (no code of the contour search).
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "cam/location/locator.h"
#include "cam/path/contour/contour_paths.h"
#include "core/surface/surface.h"

namespace patchmill::testing {

inline Surface MakeSurface(PatchModel model) {
  const RunContext run;
  auto network = BuildNetwork(std::move(model));
  if (!network.ok()) ADD_FAILURE() << network.status();
  auto surface = BuildSurface(*std::move(network), SurfaceParams{}, run);
  if (!surface.ok()) ADD_FAILURE() << surface.status();
  return *std::move(surface);
}

inline double SignedArea(const CutterPath& loop) {
  double twice = 0.0;
  for (std::size_t i = 0; i < loop.points.size(); ++i)
    twice += Cross(Xy(loop.points[i].center), Xy(loop.points[(i + 1) % loop.points.size()].center));
  return 0.5 * twice;
}

inline int CornerCount(const LevelContours& level) {
  int corners = 0;
  for (const CutterPath& loop : level.loops) {
    for (const CutterPoint& p : loop.points) corners += p.other_contact.has_value();
  }
  return corners;
}

// How often the loop runs round q, counter-clockwise counted positive.
inline int Winding(const CutterPath& loop, const Vec2& q) {
  int winding = 0;
  for (std::size_t i = 0; i < loop.points.size(); ++i) {
    const Vec2 a = Xy(loop.points[i].center) - q;
    const Vec2 b = Xy(loop.points[(i + 1) % loop.points.size()].center) - q;
    if (a.y() <= 0.0 && b.y() > 0.0 && Cross(a, b) > 0.0) ++winding;
    if (a.y() > 0.0 && b.y() <= 0.0 && Cross(a, b) < 0.0) --winding;
  }
  return winding;
}

// Vertices: closed loops at the level's height, free to 1e-9 mm, each touching its contacts.
inline void CheckVertices(const Locator& locator, const LevelContours& level) {
  for (const CutterPath& loop : level.loops) {
    EXPECT_TRUE(loop.closed);
    EXPECT_EQ(loop.kind, PassKind::kContour);
    ASSERT_GE(loop.points.size(), 3u);
    for (const CutterPoint& p : loop.points) {
      EXPECT_EQ(p.center.z(), level.z);
      const auto h = locator.Height(Xy(p.center));
      if (h) {
        EXPECT_LE(h->z, level.z + 2e-9) << p.center.transpose();
      }
      ASSERT_TRUE(p.contact.has_value());
      for (const auto& contact : {p.contact, p.other_contact}) {
        if (!contact) continue;
        const Vec2 d = Xy(p.center) - Xy(contact->p);
        const double below = std::max(0.0, level.z - contact->p.z());
        EXPECT_NEAR(std::hypot(d.x(), d.y(), below), locator.radius(), 2e-9) << p.center.transpose();
      }
    }
  }
}

struct ProbeCount {
  int probes = 0, gouges = 0, excesses = 0;
};
// Points along every chord: a ball smaller by the tolerance must be free there, one larger must not.
inline ProbeCount ProbeChords(const Surface& surface, double radius, const LevelContours& level, double gouge,
                              double excess, int per_chord) {
  const Locator smaller(surface, radius - gouge), larger(surface, radius + excess);
  ProbeCount count;
  for (const CutterPath& loop : level.loops) {
    for (std::size_t i = 0; i < loop.points.size(); ++i) {
      const Vec2 a = Xy(loop.points[i].center);
      const Vec2 b = Xy(loop.points[(i + 1) % loop.points.size()].center);
      for (int k = 1; k <= per_chord; ++k) {
        const Vec2 q = a + (b - a) * (k / (per_chord + 1.0));
        ++count.probes;
        if (!smaller.Free(Lift(q, level.z), 1e-9)) ++count.gouges;
        if (larger.Free(Lift(q, level.z), -1e-9)) ++count.excesses;
      }
    }
  }
  return count;
}

// Nodes of a grid of plan points: forbidden exactly where the loops say so. Nodes closer to the border than
// the tolerance are not asked. Returns the number of wrong ones.
inline int WrongNodes(const Surface& surface, double radius, const LevelContours& level, double tolerance,
                      double step) {
  const Locator smaller(surface, radius - tolerance), larger(surface, radius + tolerance);
  int wrong = 0;
  for (double x = surface.box.min.x() - radius; x <= surface.box.max.x() + radius; x += step) {
    for (double y = surface.box.min.y() - radius; y <= surface.box.max.y() + radius; y += step) {
      const Vec2 q(x, y);
      const bool deep_forbidden = !smaller.Free(Lift(q, level.z)), deep_free = larger.Free(Lift(q, level.z));
      if (!deep_forbidden && !deep_free) continue;
      int winding = 0;
      for (const CutterPath& loop : level.loops) winding += Winding(loop, q);
      wrong += winding != (deep_forbidden ? -1 : 0);
    }
  }
  return wrong;
}

// A part with its levels, each of them checked.
struct TracedModel {
  explicit TracedModel(PatchModel model, double radius = 3.0)
      : surface(MakeSurface(std::move(model))), locator(surface, radius) {}
  // `excess`: what probes may find left over; in cells below the resolution it is half their diagonal
  // ([contours T8d]).
  LevelContours At(double z, double excess = ContourParams{}.pass.chord_tolerance) const {
    const RunContext run;
    LevelContours level = TraceLevel(locator, z, params, run);
    CheckVertices(locator, level);
    const double tol = params.pass.chord_tolerance;
    const ProbeCount count = ProbeChords(surface, locator.radius(), level, 1.001 * tol, 1.001 * excess, 3);
    EXPECT_EQ(count.gouges, 0) << "of " << count.probes;
    EXPECT_EQ(count.excesses, 0) << "of " << count.probes;
    return level;
  }
  ContourParams params;
  Surface surface;
  Locator locator;
};

inline double LargestRadiusError(const CutterPath& loop, const Vec2& center, double radius) {
  double error = 0.0;
  for (const CutterPoint& p : loop.points)
    error = std::max(error, std::abs((Xy(p.center) - center).norm() - radius));
  return error;
}

}  // namespace patchmill::testing
