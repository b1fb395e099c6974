// Replaces dense stations by few long chords [location, section 11]. From a vertex a funnel of directions is
// narrowed from station to station, until no chord fits through it.
//
// A chord between two free centres lies above a surface that is concave along the path. Such a chord gouges
// nothing and leaves material, which the tolerances allow far less than gouging. There vertices are
// lowered into the surface, by at most half of the allowed gouge (DeepestVertex). Then chords become as long
// as on a convex surface.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "cam/location/locator.h"
#include "core/base/run_context.h"

namespace patchmill {

// A centre that touches the surface.
struct ChordStation {
  Vec3 center = Vec3::Zero();
  Vec3 away = Vec3::UnitZ();  // unit vector away from the surface; vertices are lowered against it
  // Contacts of the ball: `left` on the chord from the station before, `right` on the chord to the next
  // station. The two differ at a contact switch. Null: the ball rests on the floor.
  const SurfacePoint* left = nullptr;
  const SurfacePoint* right = nullptr;
  bool keep = false;    // there must be a vertex exactly here
  bool proven = false;  // the centre is proven free, to the certificate gap
};

struct ChordLimits {
  double gouge = 0.005;        // mm, of every chord
  double excess = 0.005;       // mm, of every chord
  double deepest = 0.0;        // mm: how far vertices may be lowered into the surface, < gouge
  double longest = kInfinity;  // mm: longest chord that leaves out a station
  double floor_center = -kInfinity;
  double certificate_gap = 0.0;  // mm: a proven centre usually lies at most this far above its station
};

// A vertex over station `station`: `below` (mm, >= 0) from its proven centre, against `away`.
struct ChordVertex {
  std::size_t station = 0;
  double below = 0.0;
};

// Returns the proven centre of a station: free, at or above the station. Called a few times for each vertex.
using ProvenCenter = std::function<Vec3(std::size_t)>;

// Returns the vertices: the first station, the last, all kept ones, and what else is needed. Precondition:
// chords between neighbouring stations are within the limits. Chord excess is proven by [location T3] on the
// stations' supports and on points of the surface between their contacts. Gouge is proven by [location T2b]
// from the proven centres between, or by the swept query. Every chord touches the surface somewhere, or comes
// as near to it as the excess of neighbouring stations; so no chord is lowered all along. Kept stations, ends
// and places on the floor stay where they are. Cost: O(n) closed forms and a swept query or two per vertex.
// `run` is polled when set; once it is cancelled the vertices end early.
std::vector<ChordVertex> FewestChords(const Locator& locator, std::span<const ChordStation> stations,
                                      const ChordLimits& limits, const ProvenCenter& proven,
                                      const RunContext* run = nullptr);

// How far (mm) vertices go down: at most half of `gouge`, less as `excess` grows, and not at all if chords
// may leave 0.6 of what they may gouge.
double DeepestVertex(double gouge, double excess);

}  // namespace patchmill
