#include "core/joining/network_findings.h"

#include <algorithm>

#include <fmt/format.h>

namespace patchmill {
namespace {

constexpr int kMaxOfACode = 1000;

std::string Path(std::string_view list, int index, const std::string& id) {
  return id.empty() ? fmt::format("network.{}[{}]", list, index)
                    : fmt::format("network.{}[{}] ({})", list, index, id);
}

}  // namespace

Where NetworkWriter::AtVertex(int vertex) const {
  Where where;
  const NetworkVertex& v = network_.vertices[static_cast<std::size_t>(vertex)];
  where.field = Path("vertices", vertex, v.id);
  if (v.position.allFinite()) where.point = v.position;
  return where;
}

Where NetworkWriter::AtEdge(int edge) const {
  Where where;
  where.field = Path("edges", edge, network_.edges[static_cast<std::size_t>(edge)].id);
  return where;
}

Where NetworkWriter::AtFace(int face) const {
  Where where;
  const NetworkFace& f = network_.faces[static_cast<std::size_t>(face)];
  where.field = Path("faces", face, f.id);
  where.patch_id = f.id;
  where.patch_index = face;
  return where;
}

void NetworkWriter::Add(std::string_view code, Where where, std::string_view text) const {
  if (++count_[std::string(code)] > kMaxOfACode) return;
  std::string message = fmt::format("{} {}", where.field, text);
  to_.push_back({std::string(code), Severity::kError, std::move(message), std::move(where)});
}

bool HasError(const Diagnostics& findings) {
  return std::ranges::any_of(findings, [](const Diagnostic& d) { return d.severity == Severity::kError; });
}

}  // namespace patchmill
