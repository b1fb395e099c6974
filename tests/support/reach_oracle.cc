#include "tests/support/reach_oracle.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_map>

namespace patchmill::testing {
namespace {

constexpr double kSpacing = 0.05;   // of the radius: between samples
constexpr double kVertical = 1e-5;  // |e_z|, as well as differences tell
constexpr int kStarts = 12;

struct Sample {
  Vec3 p;
  int patch;
  double u, v;
};

// Into the patch's domain.
Vec2 Clamped(const PatchShape& shape, const Vec2& q) {
  Vec2 in = q.cwiseMax(0.0).cwiseMin(1.0);
  if (IsTriangle(shape) && in.sum() > 1.0) {
    const double t = std::clamp(0.5 * (in.x() - in.y() + 1.0), 0.0, 1.0);
    in = {t, 1.0 - t};
  }
  return in;
}

Vec3 At(const PatchShape& shape, const Vec2& q) { return Position(shape, q.x(), q.y()); }

// S_u x S_v by differences; one-sided at the border.
Vec3 Cross(const PatchShape& shape, const Vec2& q) {
  constexpr double kStep = 1e-5;
  Vec3 d[2];
  for (int k = 0; k < 2; ++k) {
    const Vec2 step = kStep * Vec2::Unit(k);
    const auto inside = [&](const Vec2& x) { return Clamped(shape, x) == x ? x : q; };
    const Vec2 high = inside(q + step), low = inside(q - step);
    d[k] = (At(shape, high) - At(shape, low)) / (high - low)[k];
  }
  return d[0].cross(d[1]);
}

double Side(const PatchShape& shape, bool along_u) {
  double longest = 0.0;
  for (const double across : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    double length = 0.0;
    for (int i = 0; i < 8; ++i) {
      const auto at = [&](double t) {
        return At(shape, Clamped(shape, along_u ? Vec2(t, across) : Vec2(across, t)));
      };
      length += (at((i + 1) / 8.0) - at(i / 8.0)).norm();
    }
    longest = std::max(longest, length);
  }
  return longest;
}

class Oracle {
 public:
  Oracle(const PatchModel& model, const ReachQuestion& question)
      : model_(model), question_(question), radius_(question.radius - 0.5 * question.tolerance) {
    const double spacing = kSpacing * question.radius;
    for (std::size_t k = 0; k < model.patches.size(); ++k) {
      const PatchShape& shape = model.patches[k].shape;
      const int nu = 2 + static_cast<int>(Side(shape, true) / spacing),
                nv = 2 + static_cast<int>(Side(shape, false) / spacing);
      for (int i = 0; i <= nu; ++i) {
        for (int j = 0; j <= nv; ++j) {
          const Vec2 q(static_cast<double>(i) / nu, static_cast<double>(j) / nv);
          if (IsTriangle(shape) && q.sum() > 1.0 + 1e-12) continue;
          const Vec3 p = At(shape, Clamped(shape, q));
          cells_[Cell(Xy(p))].push_back({p, static_cast<int>(k), q.x(), q.y()});
        }
      }
      steps_.emplace_back(1.0 / nu, 1.0 / nv);
    }
  }

  bool Reachable(const Vec3& p, const Vec3& cross) const {
    Vec3 e = cross.normalized();
    if (e.z() < 0.0) e = -e;
    if (FreeAt(p + question_.radius * e)) return true;
    return e.z() < kVertical && FreeAt(p - question_.radius * e);
  }

 private:
  std::int64_t Cell(const Vec2& q) const {
    const auto place = [&](double x) { return static_cast<std::int64_t>(std::floor(x / radius_)); };
    return place(q.x()) * 1'000'003 + place(q.y());
  }

  // Distance of p from the upward ray at c.
  static double Distance(const Vec3& p, const Vec3& c) {
    return std::hypot(p.x() - c.x(), p.y() - c.y(), std::min(p.z() - c.z(), 0.0));
  }

  bool FreeAt(const Vec3& c) const {
    if (c.z() - question_.radius < question_.floor_z - 0.5 * question_.tolerance) return false;
    struct Hit {
      double distance;
      const Sample* sample;
    };
    std::vector<Hit> hits;
    for (int i = -1; i <= 1; ++i) {
      for (int j = -1; j <= 1; ++j) {
        const auto cell = cells_.find(Cell(Xy(c) + radius_ * Vec2(i, j)));
        if (cell == cells_.end()) continue;
        for (const Sample& s : cell->second) {
          const double distance = Distance(s.p, c);
          if (distance < radius_) return false;
          if (distance < radius_ + kSpacing * question_.radius) hits.push_back({distance, &s});
        }
      }
    }
    std::sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) { return a.distance < b.distance; });
    std::vector<const Sample*> starts;
    for (const Hit& hit : hits) {
      const Vec2 step = steps_[static_cast<std::size_t>(hit.sample->patch)];
      const bool fresh = std::none_of(starts.begin(), starts.end(), [&](const Sample* s) {
        return s->patch == hit.sample->patch && std::abs(s->u - hit.sample->u) < 2.5 * step.x() &&
               std::abs(s->v - hit.sample->v) < 2.5 * step.y();
      });
      if (!fresh) continue;
      if (Polished(*hit.sample, c) < radius_) return false;
      starts.push_back(hit.sample);
      if (starts.size() == kStarts) break;
    }
    return true;
  }

  // Pattern search, down to steps of about 0.002 of the radius: their square is what the distance is off by.
  double Polished(const Sample& start, const Vec3& c) const {
    const PatchShape& shape = model_.patches[static_cast<std::size_t>(start.patch)].shape;
    Vec2 q(start.u, start.v);
    double best = Distance(start.p, c);
    Vec2 step = steps_[static_cast<std::size_t>(start.patch)];
    for (int halving = 0; halving < 6 && best >= radius_;) {
      Vec2 next = q;
      double nearest = best;
      for (int k = 0; k < 8; ++k) {
        const Vec2 at =
            Clamped(shape, q + step.cwiseProduct(Vec2(std::cos(k * kPi / 4), std::sin(k * kPi / 4))));
        const double distance = Distance(At(shape, at), c);
        if (distance >= nearest) continue;
        nearest = distance;
        next = at;
      }
      if (nearest < best) {
        best = nearest;
        q = next;
      } else {
        step *= 0.5;
        ++halving;
      }
    }
    return best;
  }

  const PatchModel& model_;
  const ReachQuestion question_;
  const double radius_;  // of the ball that must be free
  std::unordered_map<std::int64_t, std::vector<Sample>> cells_;
  std::vector<Vec2> steps_;  // between samples, of each patch
};

}  // namespace

ReachCount CountUnreachable(const PatchModel& model, const ReachQuestion& question, int places,
                            Random& random) {
  const Oracle oracle(model, question);
  constexpr int kRough = 8;
  std::vector<double> rough;
  double whole = 0.0;
  for (const Patch& patch : model.patches) {
    double area = 0.0;
    for (int k = 0; k < kRough * kRough; ++k) {
      const Vec2 q((k / kRough + 0.5) / kRough, (k % kRough + 0.5) / kRough);
      area += Cross(patch.shape, Clamped(patch.shape, q)).norm() / (kRough * kRough);
    }
    rough.push_back(area);
    whole += area;
  }
  ReachCount count;
  double variance = 0.0;
  for (std::size_t k = 0; k < model.patches.size(); ++k) {
    const PatchShape& shape = model.patches[k].shape;
    const int n = std::max(2, static_cast<int>(std::lround(std::sqrt(0.5 * places * rough[k] / whole))));
    const double cell = (IsTriangle(shape) ? 0.5 : 1.0) / (n * n);
    for (int c = 0; c < n * n; ++c) {
      double blocked[2];
      for (double& part : blocked) {
        Vec2 q((c / n + random.Unit()) / n, (c % n + random.Unit()) / n);
        if (IsTriangle(shape) && q.sum() > 1.0) q = Vec2(1.0, 1.0) - q;
        const Vec3 cross = Cross(shape, q);
        const double area = 0.5 * cell * cross.norm();
        count.area += area;
        part = cross.norm() > 0.0 && oracle.Reachable(At(shape, q), cross) ? 0.0 : area;
        count.unreachable += part;
      }
      variance += (blocked[0] - blocked[1]) * (blocked[0] - blocked[1]);
    }
  }
  count.deviation = std::sqrt(variance);
  return count;
}

}  // namespace patchmill::testing
