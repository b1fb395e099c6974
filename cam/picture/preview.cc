#include "cam/picture/preview.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "cam/picture/facets.h"
#include "cam/picture/label_places.h"
#include "cam/picture/legend.h"
#include "cam/picture/move_lines.h"
#include "cam/picture/pass_order.h"
#include "cam/picture/seen_lines.h"
#include "cam/picture/svg_writer.h"
#include "cam/picture/view.h"

namespace patchmill {
namespace {

constexpr double kViewSize = 620.0;  // px, side of each view
constexpr double kMargin = 24.0;
constexpr double kHead = 70.0;                          // px, height of title and notes
constexpr double kLegendWidth = 300.0;                  // px
constexpr double kLabelSize = 12.0, kLabelRoom = 14.0;  // px

void DrawSurface(const PreviewInput& input, const View& view, Paint paint, LabelPlaces& places,
                 SvgWriter& svg) {
  // Strokes of this width close the seams that anti-aliasing leaves between facets.
  svg.OpenGroup(
      "fill=\"currentColor\" stroke=\"currentColor\" stroke-width=\"0.8\" stroke-linejoin=\"round\"");
  for (const Facet& f : MakeFacets(input, view, paint)) {
    std::array<Vec2, 4> points;
    for (std::size_t k = 0; k < 4; ++k) points[k] = view(f.corners[k]);
    svg.Polygon({points.begin(), points.end()}, fmt::format("color=\"{}\"", f.color));
    places.Paint(points, f.region);
  }
  svg.CloseGroup();
}

// Draws the labels of the regions where these are widest, with a white outline.
void DrawLabels(const PreviewInput& input, const LabelPlaces& places, SvgWriter& svg) {
  const auto found = places.Find(input.regions.size(), kLabelRoom);
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (!found[k]) continue;
    const Vec2 at = *found[k] + Vec2(0, 0.35 * kLabelSize);
    for (const char* style : {"stroke=\"#ffffff\" stroke-width=\"3\" stroke-linejoin=\"round\" ", ""}) {
      svg.Text(at, kLabelSize, input.regions[k].label,
               fmt::format("{}text-anchor=\"middle\" font-weight=\"bold\"", style));
    }
  }
}

// Draws the borders of regions. A view by slope or curvature gets only those that belong to it.
void DrawBorders(const PreviewInput& input, Paint paint, const SeenLines& seen, SvgWriter& svg) {
  for (const PreviewLines& lines : input.borders) {
    if (paint != Paint::kRegions && lines.on != paint) continue;
    svg.OpenGroup(fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"1.1\"", lines.color));
    for (const std::vector<Vec3>& line : lines.polylines) seen.Draw(line, svg);
    svg.CloseGroup();
  }
}

void DrawNodes(const PreviewInput& input, const View& view, const SeenLines& seen, SvgWriter& svg) {
  for (const Vec3& node : input.nodes) {
    if (seen.Sees(node)) DrawNode(view(node), svg);
  }
}

void DrawOpenEdges(const PreviewInput& input, const SeenLines& seen, SvgWriter& svg) {
  constexpr int kSteps = 24;  // chords of one edge
  svg.OpenGroup("fill=\"none\" stroke=\"#000000\" stroke-width=\"1.6\"");
  const PatchNetwork& network = input.surface->network;
  for (const EdgeLink& link : network.edges) {
    if (link.neighbor || link.collapsed || link.on_t_junction) continue;
    const PatchId patch = link.self.patch;
    std::vector<Vec3> points;
    for (int i = 0; i <= kSteps; ++i) {
      const Vec2 uv = EdgeParameters(network.model.patches[patch.index()].shape, link.self.edge,
                                     static_cast<double>(i) / kSteps);
      points.push_back(Evaluate(*input.surface, patch, uv.x(), uv.y()).p);
    }
    seen.Draw(points, svg);
  }
  svg.CloseGroup();
}

void DrawLines(const PreviewInput& input, const SeenLines& seen, SvgWriter& svg) {
  for (const PreviewLines& lines : input.lines) {
    svg.OpenGroup(fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"1\"", lines.color));
    for (const std::vector<Vec3>& line : lines.polylines) seen.Draw(line, svg);
    svg.CloseGroup();
  }
}

// The largest round length (1, 2 or 5 times a power of ten, mm) up to a sixth of the view.
double ScaleBarLength(double px_per_mm) {
  const double wish = kViewSize / 6.0 / px_per_mm;
  const double decade = std::pow(10.0, std::floor(std::log10(wish)));
  for (const double m : {5.0, 2.0, 1.0}) {
    if (m * decade <= wish) return m * decade;
  }
  return decade;
}

void DrawScale(const View& view, const Vec2& at, SvgWriter& svg) {
  const double length = ScaleBarLength(view.scale);
  const Vec2 end = at + Vec2(length * view.scale, 0);
  svg.Line(at, end, "stroke=\"#000\" stroke-width=\"2\"");
  for (const Vec2& p : {at, end})
    svg.Line(p - Vec2(0, 4), p + Vec2(0, 4), "stroke=\"#000\" stroke-width=\"1\"");
  svg.Text(end + Vec2(8, 4), 12, fmt::format("{:g} mm", length));
}

struct Panel {
  View view;
  Paint paint;
  const char* caption;
};

// Draws the part in one view, with borders, edges and lines, and a scale below it.
void DrawPanel(const PreviewInput& input, const Panel& panel, const Vec2& corner, SvgWriter& svg) {
  LabelPlaces places(corner, {kViewSize, kViewSize});
  DrawSurface(input, panel.view, panel.paint, places, svg);
  const SeenLines seen(*input.surface, panel.view, corner, {kViewSize, kViewSize},
                       2 * FacetsPerSide(*input.surface));
  DrawBorders(input, panel.paint, seen, svg);
  DrawOpenEdges(input, seen, svg);
  if (panel.paint == Paint::kRegions) {
    DrawLines(input, seen, svg);
    DrawNodes(input, panel.view, seen, svg);
    if (input.toolpath == nullptr) DrawLabels(input, places, svg);
  }
  const double foot = corner.y() + kViewSize + kMargin - 10;
  DrawScale(panel.view, {corner.x(), foot}, svg);
  svg.Text({corner.x() + 200, foot + 4}, 12, panel.caption);
}

}  // namespace

std::string DrawPreview(const PreviewInput& input, std::size_t max_bytes) {
  Box3 box = input.surface->box;
  if (input.toolpath != nullptr) {  // centres lie up to a radius beside the part, leads a little more
    const double beside = 1.5 * input.toolpath->ball_radius;
    box.min -= Vec3(beside, beside, 0);
    box.max += Vec3(beside, beside, 0);
  }
  std::vector<Panel> panels = {{TopView(), Paint::kRegions, "from above; red cross: program zero"},
                               {IsometricView(), Paint::kRegions, "isometric"}};
  if (input.shadings) {
    panels.push_back({TopView(), Paint::kSlope, "slope, from above"});
    panels.push_back({TopView(), Paint::kCurvature, "curvature of contours, from above"});
  }
  const double row = kViewSize + 2 * kMargin;
  const double legend_x = 3 * kMargin + 2 * kViewSize;
  const double height = kHead + row * static_cast<double>((panels.size() + 1) / 2);
  SvgWriter svg(legend_x + kLegendWidth, height);
  svg.Rect({0, 0}, legend_x + kLegendWidth, height, "fill=\"#ffffff\"");
  svg.Text({kMargin, 26}, 18, input.title, "font-weight=\"bold\"");
  for (std::size_t i = 0; i < input.notes.size() && i < 2; ++i)
    svg.Text({kMargin, 44 + 15.0 * static_cast<double>(i)}, 12, input.notes[i]);

  for (std::size_t k = 0; k < panels.size(); ++k) {
    const Vec2 corner(kMargin + static_cast<double>(k % 2) * (kMargin + kViewSize),
                      kHead + 10 + row * static_cast<double>(k / 2));
    panels[k].view = FitView(panels[k].view, box, corner, kViewSize, kViewSize - 30);
    DrawPanel(input, panels[k], corner, svg);
  }
  if (input.toolpath != nullptr) {
    // A vertex takes 14 bytes. Vertices are drawn so far apart that both views fit.
    const std::size_t left = max_bytes > svg.size() ? max_bytes - svg.size() : 0;
    const double vertices = 2.0 * static_cast<double>(input.toolpath->moves.size());
    const double apart =
        std::clamp(0.5 * 14.0 * vertices / std::max(1.0, static_cast<double>(left)), 0.6, 12.0);
    for (std::size_t k = 0; k < 2; ++k) {
      using enum MoveLine;  // rapids come first, then links, so that cuts are drawn over them
      for (const MoveLine line : {kRapid, kLink, kZigzag, kContour, kBorder, kCrease, kRest}) {
        DrawMoves(input, panels[k].view, line, apart, svg);
      }
      DrawPassOrder(input, panels[k].view, svg);
    }
  }
  for (std::size_t k = 0; k < 2; ++k) {
    const Vec2 zero = panels[k].view(input.program_zero);
    svg.Line(zero - Vec2(7, 0), zero + Vec2(7, 0), "stroke=\"#d00000\" stroke-width=\"1.2\"");
    svg.Line(zero - Vec2(0, 7), zero + Vec2(0, 7), "stroke=\"#d00000\" stroke-width=\"1.2\"");
  }
  DrawLegend(input, {legend_x, kHead}, svg);
  return std::move(svg).Finish();
}

}  // namespace patchmill
