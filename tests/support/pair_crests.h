// The crests that neighbouring passes leave between them, by brute force on the surface itself.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "cam/toolpath/cutter_path.h"
#include "core/diffgeo/forms.h"
#include "core/surface/surface.h"

namespace patchmill::testing {

// Which path is nearest to a place, and how near. Segments are hashed by cubes that they pass through.
class NearestPath {
 public:
  NearestPath(const std::vector<CutterPath>& paths, double cell) : cell_(cell) {
    for (std::size_t k = 0; k < paths.size(); ++k) {
      const std::vector<CutterPoint>& points = paths[k].points;
      const std::size_t n = points.size(), moves = paths[k].closed ? n : n - 1;
      for (std::size_t i = 0; i < moves; ++i) Add(points[i].center, points[(i + 1) % n].center, k);
    }
  }

  struct Found {
    double distance = 0.0;  // mm, from p
    std::size_t path = 0;
  };
  // The path nearest to p among those within a cell of the place c, if any.
  std::optional<Found> At(const Vec3& p, const Vec3& c) const {
    std::optional<Found> best;
    const Key k = KeyOf(c);
    for (int i = -1; i <= 1; ++i) {
      for (int j = -1; j <= 1; ++j) {
        const auto end = cells_.upper_bound({k[0] + i, k[1] + j, k[2] + 1});
        for (auto it = cells_.lower_bound({k[0] + i, k[1] + j, k[2] - 1}); it != end; ++it) {
          for (const std::size_t s : it->second) {
            const double d = Distance(p, segments_[s]);
            if (!best || d < best->distance) best = {d, segments_[s].path};
          }
        }
      }
    }
    return best;
  }

 private:
  using Key = std::array<int, 3>;
  struct Segment {
    Vec3 a, b;
    std::size_t path;
  };
  static double Distance(const Vec3& p, const Segment& s) {
    const Vec3 d = s.b - s.a;
    const double l2 = d.squaredNorm();
    const double f = l2 > 0.0 ? std::clamp((p - s.a).dot(d) / l2, 0.0, 1.0) : 0.0;
    return (p - s.a - f * d).norm();
  }
  Key KeyOf(const Vec3& c) const {
    return {static_cast<int>(std::floor(c.x() / cell_)), static_cast<int>(std::floor(c.y() / cell_)),
            static_cast<int>(std::floor(c.z() / cell_))};
  }
  void Add(const Vec3& a, const Vec3& b, std::size_t path) {
    const int steps = 1 + static_cast<int>((b - a).norm() / (0.25 * cell_));
    for (int k = 0; k <= steps; ++k) {
      std::vector<std::size_t>& list = cells_[KeyOf(a + (b - a) * (double(k) / steps))];
      if (list.empty() || list.back() != segments_.size()) list.push_back(segments_.size());
    }
    segments_.push_back({a, b, path});
  }

  double cell_;
  std::vector<Segment> segments_;
  std::map<Key, std::vector<std::size_t>> cells_;
};

// A place on the surface as far from one path as from another, and no nearer to any third.
struct Crest {
  Vec3 p = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();
  double leftover = 0.0;  // mm
};

struct PairOfPasses {
  std::size_t a = 0, b = 0;  // paths
  Crest worst;
  int crests = 0;
};

using PlaceFilter = std::function<bool(const Vec3& p, const Vec3& normal)>;

// Follows lines of constant u and constant v over every patch, `apart` mm from each other, in steps of
// `step` mm. Where the nearest path changes to one of another line, it halves the step until the crest
// between the two is found. Only places that `counts` accepts are used. Returns the worst crest of each
// pair.
inline std::vector<PairOfPasses> CrestsOfPairs(const Surface& surface, const std::vector<CutterPath>& paths,
                                               double radius, double apart, double step, double cell,
                                               const PlaceFilter& counts) {
  const NearestPath nearest(paths, cell);
  struct Place {
    Crest crest;
    std::optional<NearestPath::Found> near;
  };
  std::map<std::pair<std::size_t, std::size_t>, PairOfPasses> pairs;
  for (std::size_t piece = 0; piece < surface.pieces.size(); ++piece) {
    for (const bool along_u : {true, false}) {
      const auto at = [&](double t, double other) {
        const SurfaceJet jet = Evaluate(surface, PieceId(piece), along_u ? t : other, along_u ? other : t);
        Place place{{jet.p, Vec3::UnitZ(), 0.0}, {}};
        const auto e = UpwardNormal(jet);
        if (!e || !counts(jet.p, *e)) return place;
        place.crest.normal = *e;
        place.near = nearest.At(jet.p, jet.p + radius * *e);
        if (place.near) place.crest.leftover = place.near->distance - radius;
        return place;
      };
      const auto extent = [&](bool along) {  // mm, of the longest of three lines
        double longest = 0.0;
        for (const double other : {0.0, 0.5, 1.0}) {
          double length = 0.0;
          Vec3 last = Vec3::Zero();
          for (int k = 0; k <= 16; ++k) {
            const Vec3 p = (along ? at(k / 16.0, other) : at(other, k / 16.0)).crest.p;
            if (k > 0) length += (p - last).norm();
            last = p;
          }
          longest = std::max(longest, length);
        }
        return longest;
      };
      const int lines = 1 + static_cast<int>(extent(false) / apart);
      const int steps = 1 + static_cast<int>(extent(true) / step);
      for (int l = 0; l < lines; ++l) {
        const double other = (l + 0.5) / lines;
        Place last = at(0.0, other);
        for (int k = 1; k <= steps; ++k) {
          Place next = at(double(k) / steps, other);
          if (last.near && next.near &&
              paths[last.near->path].order_key != paths[next.near->path].order_key) {
            double from = double(k - 1) / steps, to = double(k) / steps;
            Place low = last, high = next;
            for (int i = 0; i < 16; ++i) {
              const double t = 0.5 * (from + to);
              Place middle = at(t, other);
              if (!middle.near) break;
              const bool here = middle.near->path == low.near->path;
              (here ? from : to) = t;
              (here ? low : high) = middle;
            }
            const Crest& crest = std::max(low.crest, high.crest, [](const Crest& x, const Crest& y) {
              return x.leftover < y.leftover;
            });
            const auto key = std::minmax(low.near->path, high.near->path);
            PairOfPasses& pair = pairs[key];
            if (pair.crests++ == 0 || crest.leftover > pair.worst.leftover) pair.worst = crest;
            pair.a = key.first;
            pair.b = key.second;
          }
          last = std::move(next);
        }
      }
    }
  }
  std::vector<PairOfPasses> all;
  for (const auto& [key, pair] : pairs) all.push_back(pair);
  return all;
}

}  // namespace patchmill::testing
