#include "core/network/findings.h"

#include <utility>

#include <fmt/format.h>

namespace patchmill {
namespace {
constexpr std::size_t kMaxPerCode = 1000;
}

std::string NetworkFindings::Name(PatchId patch) const { return Title(model_, patch); }

std::string NetworkFindings::Name(int edge) const {
  const PatchEdge e = curves_.edge(edge);
  if (model_.patches[e.patch.index()].face) return "an edge of " + Name(e.patch);
  return fmt::format("edge {} of {}", e.edge, Name(e.patch));
}

Where NetworkFindings::WhereIs(int edge) const {
  const PatchEdge e = curves_.edge(edge);
  Where where = WhereOf(model_, e.patch);
  where.uv = EdgeParameters(curves_.shape(edge), e.edge, 0.5);
  where.point = curves_.Point(edge, 0.5);
  return where;
}

Where NetworkFindings::WhereIs(PatchId patch) const {
  const Patch& p = model_.patches[patch.index()];
  Where where = WhereOf(model_, patch);
  where.uv = IsTriangle(p.shape) ? Vec2::Constant(1.0 / 3.0) : Vec2::Constant(0.5);
  where.point = Position(p.shape, where.uv->x(), where.uv->y());
  return where;
}

void NetworkFindings::AtPoint(std::string_view code, Severity severity, const Vec3& point,
                              std::string message) {
  if (!HasRoom(code)) return;
  Where where;
  where.point = point;
  Add(code, severity, std::move(where), std::move(message));
}

bool NetworkFindings::HasRoom(std::string_view code) {
  const auto it = by_code_.find(code);
  if (it == by_code_.end() || it->second.kept.size() < kMaxPerCode) return true;
  ++it->second.dropped;
  return false;
}

void NetworkFindings::Add(std::string_view code, Severity severity, Where where, std::string message) {
  auto it = by_code_.find(code);
  if (it == by_code_.end()) it = by_code_.emplace(code, List{}).first;
  it->second.kept.push_back(MakeDiagnostic(severity, code, std::move(message), std::move(where)));
}

Diagnostics NetworkFindings::Take() {
  Diagnostics all;
  for (auto& [code, list] : by_code_) {
    const Severity severity = list.kept.front().severity;
    for (Diagnostic& d : list.kept) all.push_back(std::move(d));
    if (list.dropped > 0) {
      all.push_back(MakeDiagnostic(severity, code, fmt::format("and {} more of this kind", list.dropped)));
    }
  }
  by_code_.clear();
  return all;
}

}  // namespace patchmill
