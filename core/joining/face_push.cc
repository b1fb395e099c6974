#include "core/joining/face_push.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

namespace patchmill {

EdgePlace PlaceBeside(const FacePush& push, int sides, int side) {
  const double u = push.u, v = push.v;
  if (sides == 3) {
    const double area[3] = {1.0 - u - v, u, v};
    const double from = area[side], to = area[(side + 1) % 3];
    return {from + to > 0.0 ? to / (from + to) : 0.5, area[(side + 2) % 3]};
  }
  switch (side) {
    case 0:
      return {u, v};
    case 1:
      return {v, 1.0 - u};
    case 2:
      return {1.0 - u, 1.0 - v};
    default:
      return {1.0 - v, u};
  }
}

EndVectors PushTwists(const EndVectors& along, const EndVectors& across, const EdgePlace& place,
                      double amount) {
  const double u = place.along, share = (1.0 - place.away) * amount;
  const Vec3 normal =
      (1.0 - u) * across.start.cross(along.start) + u * across.end.cross(along.end);  // [editing (1)]
  return {(1.0 - u) * share * normal, u * share * normal};
}

void CheckTwists(const CurveNetwork& network, const NetworkWriter& findings) {
  for (std::size_t f = 0; f < network.faces.size(); ++f) {
    const NetworkFace& face = network.faces[f];
    const auto error = [&](const SideTwists& twists, std::string_view text) {
      findings.Error("INVALID_TWIST", findings.AtFace(static_cast<int>(f)),
                     fmt::format("has twists from vertex {} to {} {}", twists.start, twists.end, text));
    };
    std::set<std::pair<int, int>> seen;
    for (const SideTwists& twists : face.twists) {
      const auto ends = std::minmax({twists.start, twists.end});
      bool side = false;
      for (std::size_t k = 0; k < face.vertices.size(); ++k) {
        side = side || std::minmax({face.vertices[k], face.vertices[(k + 1) % face.vertices.size()]}) == ends;
      }
      const auto finite = [](const std::optional<Vec3>& v) { return !v || v->allFinite(); };
      if (!side) {
        error(twists, "which is no side of it");
      } else if (!seen.insert(ends).second) {
        error(twists, "twice");
      } else if (!finite(twists.at_start) || !finite(twists.at_end)) {
        error(twists, "that are not finite");
      }
    }
  }
}

void CheckPushes(const CurveNetwork& network, const NetworkWriter& findings) {
  for (std::size_t f = 0; f < network.faces.size(); ++f) {
    const NetworkFace& face = network.faces[f];
    for (const auto& [u, v, amount] : face.pushes) {
      const double most = face.vertices.size() == 3 ? u + v : std::max(u, v);
      if (u >= 0.0 && v >= 0.0 && most <= 1.0 && std::isfinite(amount)) continue;
      findings.Error(
          "INVALID_PUSH", findings.AtFace(static_cast<int>(f)),
          fmt::format("is pushed at ({:g}, {:g}) by {:g}; must be inside it and finite", u, v, amount));
    }
  }
}

void CheckBulges(const CurveNetwork& network, const NetworkWriter& findings) {
  for (std::size_t f = 0; f < network.faces.size(); ++f) {
    const NetworkFace& face = network.faces[f];
    const auto error = [&](std::string_view text) {
      findings.Error("INVALID_BULGE", findings.AtFace(static_cast<int>(f)), text);
    };
    if (face.bulges.empty()) continue;
    if (face.vertices.size() != 4) {
      error("has bulges and is no quad; give it four corners, or push it");
    } else if (face.bulges.size() > kMaxBulges) {
      error(fmt::format("has {} bulges; at most {}", face.bulges.size(), kMaxBulges));
    }
    for (const auto& [u, v, by] : face.bulges) {
      const auto inside = [](double t) { return t >= kMinBulgePlace && t <= 1.0 - kMinBulgePlace; };
      if (inside(u) && inside(v) && by.allFinite()) continue;
      error(
          fmt::format("has a bulge at ({:g}, {:g}) by ({:g}, {:g}, {:g}); the place must be in [{:g}, {:g}] "
                      "both ways, and the vector finite",
                      u, v, by.x(), by.y(), by.z(), kMinBulgePlace, 1.0 - kMinBulgePlace));
    }
  }
}

}  // namespace patchmill
