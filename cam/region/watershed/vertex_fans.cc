#include "cam/region/watershed/vertex_fans.h"

namespace patchmill {

VertexFans::VertexFans(std::span<const SplitTriangle> triangles, std::size_t vertices)
    : first_(vertices, -1), last_(vertices, -1), next_(3 * triangles.size(), -1) {
  int corner = 0;
  for (const SplitTriangle& t : triangles) {
    for (const int vertex : t.vertex) Append(vertex, corner++);
  }
}

void VertexFans::AddVertex() {
  first_.push_back(-1);
  last_.push_back(-1);
}

void VertexFans::Append(int vertex, int corner) {
  int& last = last_[static_cast<std::size_t>(vertex)];
  (last < 0 ? first_[static_cast<std::size_t>(vertex)] : next_[static_cast<std::size_t>(last)]) = corner;
  last = corner;
}

void VertexFans::Replace(int vertex, int corner, int by) {
  const auto at = static_cast<std::size_t>(corner), fresh = static_cast<std::size_t>(by);
  int* link = &first_[static_cast<std::size_t>(vertex)];
  while (*link != corner) link = &next_[static_cast<std::size_t>(*link)];
  *link = by;
  next_[fresh] = next_[at];
  next_[at] = -1;
  if (int& last = last_[static_cast<std::size_t>(vertex)]; last == corner) last = by;
}

}  // namespace patchmill
