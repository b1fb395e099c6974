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
  const NetworkEdge& e = network_.edges[static_cast<std::size_t>(edge)];
  if (e.line) {
    Where where = AtLine(*e.line);
    where.field += fmt::format(" between vertices {} and {}", e.start, e.end);
    return where;
  }
  Where where;
  where.field = Path("edges", edge, e.id);
  return where;
}

Where NetworkWriter::AtLine(int line) const {
  Where where;
  where.field = Path("lines", line, "");
  return where;
}

Where NetworkWriter::AtControl(int control) const {
  Where where;
  where.field = Path("controls", control, "");
  return where;
}

Where NetworkWriter::AtFace(int face) const {
  Where where;
  const NetworkFace& f = network_.faces[static_cast<std::size_t>(face)];
  if (f.of) {
    where = AtFace(*f.of);
    where.field += fmt::format(", piece of vertices {}", fmt::join(f.vertices, " "));
    where.patch_index = face;
    return where;
  }
  where.field = Path("faces", face, f.id);
  where.patch_id = f.id;
  where.patch_index = face;
  return where;
}

void NetworkWriter::Add(std::string_view code, Severity severity, Where where, std::string_view text) const {
  if (++count_[std::string(code)] > kMaxOfACode) return;
  std::string message = fmt::format("{} {}", where.field, text);
  to_.push_back(MakeDiagnostic(severity, code, std::move(message), std::move(where)));
}

bool NetworkWriter::ErrorWritten() const { return HasError(to_); }

bool HasError(const Diagnostics& findings) {
  return std::ranges::any_of(findings, [](const Diagnostic& d) { return d.severity == Severity::kError; });
}

}  // namespace patchmill
