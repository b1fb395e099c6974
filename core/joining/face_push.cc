#include "core/joining/face_push.h"

#include <algorithm>
#include <cmath>

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

void PushTwists(const Vec3& start, const Vec3& end, const Vec3& b0, const Vec3& b1, const EdgePlace& place,
                double amount, Vec3& w0, Vec3& w1) {
  const double u = place.along, share = (1.0 - place.away) * amount;
  const Vec3 normal = (1.0 - u) * b0.cross(start) + u * b1.cross(end);  // (22)
  w0 += (1.0 - u) * share * normal;
  w1 += u * share * normal;
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

}  // namespace patchmill
