// The triangles around each vertex of a mesh that grows: chains of corners, no memory of its own per vertex.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "cam/region/split/split_mesh.h"

namespace patchmill {

// Corner 3 t + k is vertex k of triangle t.
class VertexFans {
 public:
  VertexFans(std::span<const SplitTriangle> triangles, std::size_t vertices);

  // f(t) for the triangles around a vertex, in rising order at first, then as they were added.
  template <typename F>
  void ForEach(int vertex, F&& f) const {
    for (int corner = first_[static_cast<std::size_t>(vertex)]; corner >= 0;
         corner = next_[static_cast<std::size_t>(corner)]) {
      f(corner / 3);
    }
  }

  // One without triangles yet; its number is that of the vertices before.
  void AddVertex();
  void AddTriangle() { next_.resize(next_.size() + 3, -1); }  // its corners are in no fan yet
  void Append(int vertex, int corner);
  void Replace(int vertex, int corner, int by);

 private:
  std::vector<int> first_, last_;  // corner of each vertex's fan, -1 for none
  std::vector<int> next_;          // after each corner
};

}  // namespace patchmill
