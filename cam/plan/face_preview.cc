#include "cam/plan/face_preview.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>

#include <fmt/format.h>

#include "cam/picture/preview.h"

namespace patchmill {
namespace {

constexpr std::array<std::uint32_t, 8> kPale = {0xd9e8f5, 0xf5e0d0, 0xdcefd9, 0xeadcf2,
                                                0xf5efc9, 0xd3ecec, 0xf2d9e1, 0xe3e3e3};
constexpr int kChords = 24;  // of one edge

// One colour for all faces tells nothing.
bool HasColors(const PatchModel& model) {
  return std::ranges::any_of(model.faces,
                             [&](const ModelFace& face) { return face.rgb != model.faces[0].rgb; });
}

std::string ColorOf(const std::optional<std::uint32_t>& rgb, std::size_t index) {
  return fmt::format("#{:06x}", rgb ? *rgb & 0xFFFFFFu : kPale[index % kPale.size()]);
}

std::vector<Vec3> PointsOf(const Surface& surface, const PatchEdge& edge) {
  const PatchShape& shape = surface.network.model.patches[edge.patch.index()].shape;
  std::vector<Vec3> points;
  for (int i = 0; i <= kChords; ++i) {
    const Vec2 uv = EdgeParameters(shape, edge.edge, static_cast<double>(i) / kChords);
    points.push_back(Evaluate(surface, edge.patch, uv.x(), uv.y()).p);
  }
  return points;
}

PreviewLines EdgesBetweenFaces(const Surface& surface) {
  const PatchNetwork& network = surface.network;
  const auto differ = [&](const PatchEdge& a, const PatchEdge& b) {
    return network.model.patches[a.patch.index()].face != network.model.patches[b.patch.index()].face;
  };
  PreviewLines lines;
  lines.name = "edges";
  lines.color = "#303030";
  for (const EdgeLink& link : network.edges) {
    if (!link.neighbor || *link.neighbor < link.self || !differ(link.self, *link.neighbor)) continue;
    lines.polylines.push_back(PointsOf(surface, link.self));
  }
  for (const PartLink& link : network.part_links) {
    if (differ(link.part, link.whole)) lines.polylines.push_back(PointsOf(surface, link.part));
  }
  return lines;
}

}  // namespace

std::string DrawFaces(const Surface& surface, const std::vector<FaceFigures>& figures,
                      const std::string& title) {
  const PatchModel& model = surface.network.model;
  PreviewInput input;
  input.surface = &surface;
  input.title = title;
  input.region_title = "faces";
  const bool colored = HasColors(model);
  for (std::size_t f = 0; f < model.faces.size(); ++f) {
    const ModelFace& face = model.faces[f];
    PreviewRegion& region = input.regions.emplace_back();
    region.name = fmt::format("{} {}: {:.1f} mm2", Title(face), Name(face.kind), figures[f].area);
    region.label = face.id;
    region.color = ColorOf(colored ? face.rgb : std::nullopt, f);
    region.area = figures[f].area;
  }
  input.region_of = [&surface, &model](const SurfacePoint& p) {
    const auto& face = model.patches[surface.piece(p.piece).patch.index()].face;
    return face ? face->value : -1;
  };
  PreviewLines edges = EdgesBetweenFaces(surface);
  if (!edges.polylines.empty()) input.borders.push_back(std::move(edges));
  return DrawPreview(input);
}

}  // namespace patchmill
