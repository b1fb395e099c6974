#include "core/exchange/mesh_files.h"

#include <bit>
#include <cstdint>
#include <cstring>
#include <iterator>

#include <fmt/format.h>

namespace patchmill {
namespace {

void PutBytes(std::uint32_t value, std::string& to) {
  for (int k = 0; k < 4; ++k) to.push_back(static_cast<char>((value >> (8 * k)) & 0xffu));
}
void PutFloat(double value, std::string& to) {
  PutBytes(std::bit_cast<std::uint32_t>(static_cast<float>(value)), to);
}

// The corners of a triangle, anticlockwise from the side of the normals of its vertices.
std::array<std::uint32_t, 3> Turned(const PieceTriangles& piece, const MeshTriangle& triangle) {
  std::array<std::uint32_t, 3> c = triangle.vertices;
  const MeshVertex &a = piece.vertices[c[0]], &b = piece.vertices[c[1]], &d = piece.vertices[c[2]];
  const Vec3 n = (b.at.p - a.at.p).cross(d.at.p - a.at.p);
  if (n.dot(a.normal + b.normal + d.normal) < 0.0) std::swap(c[1], c[2]);
  return c;
}

}  // namespace

std::string StlBytes(const std::vector<PieceTriangles>& mesh) {
  std::string triangles;
  std::uint32_t count = 0;
  for (const PieceTriangles& piece : mesh) {
    for (const MeshTriangle& triangle : piece.triangles) {
      std::array<Vec3, 3> p;
      const auto corners = Turned(piece, triangle);
      for (std::size_t k = 0; k < 3; ++k) p[k] = piece.vertices[corners[k]].at.p.cast<float>().cast<double>();
      if (p[0] == p[1] || p[1] == p[2] || p[2] == p[0]) continue;
      const Vec3 n = (p[1] - p[0]).cross(p[2] - p[0]);
      const Vec3 unit = n.norm() > 0.0 ? Vec3(n.normalized()) : Vec3::Zero();
      for (int k = 0; k < 3; ++k) PutFloat(unit[k], triangles);
      for (const Vec3& corner : p) {
        for (int k = 0; k < 3; ++k) PutFloat(corner[k], triangles);
      }
      triangles.append(2, '\0');
      ++count;
    }
  }
  std::string bytes = "Patchmill, mm";
  bytes.resize(80, ' ');
  PutBytes(count, bytes);
  return bytes + triangles;
}

std::string ObjText(const std::vector<PieceTriangles>& mesh) {
  std::string text = "# Patchmill, mm\n";
  std::size_t first = 1;
  for (const PieceTriangles& piece : mesh) {
    fmt::format_to(std::back_inserter(text), "o piece_{}\n", piece.piece.value);
    for (const MeshVertex& v : piece.vertices)
      fmt::format_to(std::back_inserter(text), "v {:.7f} {:.7f} {:.7f}\n", v.at.p.x(), v.at.p.y(),
                     v.at.p.z());
    for (const MeshVertex& v : piece.vertices)
      fmt::format_to(std::back_inserter(text), "vn {:.6f} {:.6f} {:.6f}\n", v.normal.x(), v.normal.y(),
                     v.normal.z());
    for (const MeshTriangle& triangle : piece.triangles) {
      const auto c = Turned(piece, triangle);
      fmt::format_to(std::back_inserter(text), "f {0}//{0} {1}//{1} {2}//{2}\n", first + c[0], first + c[1],
                     first + c[2]);
    }
    first += piece.vertices.size();
  }
  return text;
}

}  // namespace patchmill
