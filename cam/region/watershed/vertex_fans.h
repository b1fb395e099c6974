// The triangles around each vertex of a growing mesh, as chains of corners; so no vertex needs a list of its
// own.
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

  // Calls f(t) for the triangles around a vertex: those of the constructor in rising order, then others in
  // the order in which they were added.
  template <typename F>
  void ForEach(int vertex, F&& f) const {
    for (int corner = first_[static_cast<std::size_t>(vertex)]; corner >= 0;
         corner = next_[static_cast<std::size_t>(corner)]) {
      f(corner / 3);
    }
  }

  // Adds a vertex without triangles. Its number is the number of vertices before.
  void AddVertex();
  // Adds a triangle. Its corners are in no fan yet.
  void AddTriangle() { next_.resize(next_.size() + 3, -1); }
  void Append(int vertex, int corner);
  void Replace(int vertex, int corner, int by);

 private:
  std::vector<int> first_, last_;  // [vertex]: first and last corner of its fan, -1 if it is empty
  std::vector<int> next_;          // [corner]: the next one in its fan, or -1
};

}  // namespace patchmill
