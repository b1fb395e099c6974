#include "tests/support/height_oracle.h"

#include <algorithm>
#include <cmath>

namespace patchmill::testing {
namespace {

// Into the patch's domain.
void Clamp(bool triangle, double& u, double& v) {
  u = std::clamp(u, 0.0, 1.0);
  v = std::clamp(v, 0.0, 1.0);
  if (triangle && u + v > 1.0) {  // nearest point of the edge u + v = 1
    const double t = std::clamp(0.5 * (u - v + 1.0), 0.0, 1.0);
    u = t;
    v = 1.0 - t;
  }
}

}  // namespace

HeightOracle::HeightOracle(const PatchModel& model, double radius, int samples)
    : model_(model), radius_(radius), step_(1.0 / samples) {
  for (int k = 0; k < static_cast<int>(model.patches.size()); ++k) {
    const PatchShape& shape = model.patches[static_cast<std::size_t>(k)].shape;
    for (int i = 0; i <= samples; ++i) {
      for (int j = 0; j <= (IsTriangle(shape) ? samples - i : samples); ++j) {
        const float u = static_cast<float>(i) / static_cast<float>(samples),
                    v = static_cast<float>(j) / static_cast<float>(samples);
        samples_.push_back({Position(shape, u, v), k, u, v});
      }
    }
  }
}

double HeightOracle::Value(const Vec2& q, int patch, double u, double v) const {
  const Vec3 p = Position(model_.patches[static_cast<std::size_t>(patch)].shape, u, v);
  const double rim = radius_ * radius_ - (Xy(p) - q).squaredNorm();
  return rim >= 0.0 ? p.z() + std::sqrt(rim) : -kInfinity;
}

// Pattern search: the best of 16 directions at a shrinking step, along the border too.
double HeightOracle::Polish(const Vec2& q, const Sample& start) const {
  const bool triangle = IsTriangle(model_.patches[static_cast<std::size_t>(start.patch)].shape);
  double u = start.u, v = start.v, best = Value(q, start.patch, u, v);
  for (double step = step_; step > 1e-10;) {
    double next_u = u, next_v = v, next = best;
    for (int k = 0; k < 16; ++k) {
      double x = u + step * std::cos(k * kPi / 8.0), y = v + step * std::sin(k * kPi / 8.0);
      Clamp(triangle, x, y);
      const double value = Value(q, start.patch, x, y);
      if (value > next) {
        next = value;
        next_u = x;
        next_v = y;
      }
    }
    if (next > best) {
      best = next;
      u = next_u;
      v = next_v;
    } else {
      step *= 0.5;
    }
  }
  return best;
}

HeightOracle::Answer HeightOracle::Height(const Vec2& q) const {
  struct Hit {
    double value;
    const Sample* sample;
  };
  std::vector<Hit> hits;
  for (const Sample& s : samples_) {
    const double rim = radius_ * radius_ - (Xy(s.p) - q).squaredNorm();
    if (rim >= 0.0) hits.push_back({s.p.z() + std::sqrt(rim), &s});
  }
  Answer answer;
  std::sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) { return a.value > b.value; });
  if (hits.empty()) return answer;
  answer.sampled = hits.front().value;
  // Starts: the best samples that are not neighbours of one taken before.
  std::vector<const Sample*> starts;
  for (const Hit& hit : hits) {
    const bool fresh = std::none_of(starts.begin(), starts.end(), [&](const Sample* s) {
      return s->patch == hit.sample->patch && std::abs(s->u - hit.sample->u) < 2.5 * step_ &&
             std::abs(s->v - hit.sample->v) < 2.5 * step_;
    });
    if (fresh) starts.push_back(hit.sample);
    if (starts.size() == 8) break;
  }
  for (const Sample* s : starts) answer.polished = std::max(answer.polished, Polish(q, *s));
  return answer;
}

}  // namespace patchmill::testing
