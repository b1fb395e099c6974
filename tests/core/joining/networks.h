// Curve networks for the tests of joining, and their findings as text.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/diagnostic.h"
#include "core/joining/curve_network.h"
#include "tests/support/random.h"

namespace patchmill::testing {

// "CODE: message" a line.
inline std::string Text(const Diagnostics& findings) {
  std::string text;
  for (const Diagnostic& d : findings) text += d.code + ": " + d.message + "\n";
  return text;
}

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

// G2-Gregory faces: n x m vertices on a wavy sheet, moved at random, with a line through every row and
// column; faces in random order of corners.
inline CurveNetwork LineSheet(std::uint64_t seed, int n, int m) {
  Random random(seed);
  CurveNetwork network;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < m; ++j) {
      NetworkVertex v;
      v.position = Vec3(10 * i, 12 * j, 5 * std::sin(0.7 * i) * std::cos(0.6 * j)) + random.Point(-1.5, 1.5);
      network.vertices.push_back(v);
    }
  }
  for (int i = 0; i < n; ++i) {
    NetworkLine line;
    for (int j = 0; j < m; ++j) line.vertices.push_back(i * m + j);
    network.lines.push_back(line);
  }
  for (int j = 0; j < m; ++j) {
    NetworkLine line;
    for (int i = 0; i < n; ++i) line.vertices.push_back(i * m + j);
    network.lines.push_back(line);
  }
  for (int i = 0; i + 1 < n; ++i) {
    for (int j = 0; j + 1 < m; ++j) {
      std::vector<int> loop = {i * m + j, (i + 1) * m + j, (i + 1) * m + j + 1, i * m + j + 1};
      std::rotate(loop.begin(), loop.begin() + random.Int(4), loop.end());
      if (random.Int(2) == 0) std::reverse(loop.begin(), loop.end());
      network.faces.push_back({"", loop, PatchScheme::kG2Gregory, {}});
    }
  }
  return network;
}

}  // namespace patchmill::testing
