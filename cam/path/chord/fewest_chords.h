// The fewest chords along centres on the surface of h or on a contour: a funnel of directions, narrowed from
// station to station.
//
// Where the ground is hollow along the way, chords between free centres lie above it, and may leave far less
// than they may take: there vertices go down into the ground by what chords may take, so that chords come out
// as long as on bulging ground.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "cam/location/locator.h"
#include "core/base/run_context.h"

namespace patchmill {

// A centre that touches the ground.
struct ChordStation {
  Vec3 center = Vec3::Zero();
  Vec3 away = Vec3::UnitZ();            // unit: out of the ground, against the way vertices go down
  const SurfacePoint* left = nullptr;   // what it touches, towards the station before
  const SurfacePoint* right = nullptr;  // and the one after; null: the floor
  bool keep = false;                    // a vertex, just here
  bool proven = false;                  // the centre is proven free, to the certificate gap
};

struct ChordLimits {
  double gouge = 0.005;        // mm, of every chord
  double excess = 0.005;       // mm, of every chord
  double deepest = 0.0;        // mm: how far into the ground vertices may go, < gouge
  double longest = kInfinity;  // mm, of a chord that passes over stations
  double floor_center = -kInfinity;
  double certificate_gap = 0.0;  // mm: proven centres lie as far above their stations at most, mostly
};

// Vertex over station `station`, from its proven centre `below` (mm, >= 0) against `away`.
struct ChordVertex {
  std::size_t station = 0;
  double below = 0.0;
};

// The proven centre of a station: free, above or at the station. Called a few times for each vertex.
using ProvenCenter = std::function<Vec3(std::size_t)>;

// Vertices: the first station, the last, all kept ones, and what else is needed. Neighbouring stations are
// joined by chords within the limits already. Chord excess is proven by [location T3] on the stations'
// supports and points of the surface between their contacts, gouge by [location T2b] from the proven centres
// between or the swept query; every chord touches the ground somewhere or comes within the excess of
// neighbouring stations to it, so that it is nowhere lowered all along. Kept stations, ends and places on the
// floor stay where they are. O(n) closed forms, a swept query per vertex or two. `run` is polled when set:
// cancelled, the vertices end early.
std::vector<ChordVertex> FewestChords(const Locator& locator, std::span<const ChordStation> stations,
                                      const ChordLimits& limits, const ProvenCenter& proven,
                                      const RunContext* run = nullptr);

// How far vertices go down: half of what chords may take, where they may leave that much less; else not at
// all.
double DeepestVertex(double gouge, double excess);

}  // namespace patchmill
