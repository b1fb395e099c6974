// Curve networks for the tests of joining.
#pragma once

#include "core/joining/curve_network.h"
#include "tests/support/random.h"

namespace patchmill::testing {

// Closed: 12 vertices, 6 quads and 8 triangles with mixed orientation, moved and turned a little at random.
inline CurveNetwork Cuboctahedron(std::uint64_t seed, double move = 0.12) {
  Random random(seed);
  CurveNetwork network;
  std::vector<Vec3> places;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double a : {-1.0, 1.0}) {
      for (const double b : {-1.0, 1.0}) {
        Vec3 p = Vec3::Zero();
        p[(axis + 1) % 3] = a;
        p[(axis + 2) % 3] = b;
        places.push_back(p);
        NetworkVertex vertex;
        vertex.position = 10 * (p + random.Point(-move, move));
        vertex.normals = {{p + random.Point(-move, move), {}}};
        network.vertices.push_back(vertex);
      }
    }
  }
  const auto find = [&](const Vec3& p) {
    int k = 0;
    while ((places[static_cast<std::size_t>(k)] - p).norm() > 0.1) ++k;
    return k;
  };
  for (int axis = 0; axis < 3; ++axis) {
    for (const double s : {-1.0, 1.0}) {
      NetworkFace face;
      for (const Vec2& q : {Vec2(1, 0), Vec2(0, 1), Vec2(-1, 0), Vec2(0, -1)}) {
        Vec3 p = Vec3::Zero();
        p[axis] = s;
        p[(axis + 1) % 3] = q.x();
        p[(axis + 2) % 3] = q.y();
        face.vertices.push_back(find(p));
      }
      network.faces.push_back(face);
    }
  }
  for (int k = 0; k < 8; ++k) {
    const double x = k & 1 ? 1 : -1, y = k & 2 ? 1 : -1, z = k & 4 ? 1 : -1;
    NetworkFace face;
    face.vertices = {find(Vec3(x, y, 0)), find(Vec3(x, 0, z)), find(Vec3(0, y, z))};
    network.faces.push_back(face);
  }
  return network;
}

}  // namespace patchmill::testing
