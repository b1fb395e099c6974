#include "cam/picture/preview.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "cam/picture/facets.h"
#include "cam/picture/label_places.h"
#include "cam/picture/seen_lines.h"
#include "cam/picture/svg_writer.h"
#include "cam/picture/view.h"

namespace patchmill {
namespace {

constexpr double kViewSize = 620.0;  // px, each of the two views
constexpr double kMargin = 24.0;
constexpr double kHead = 70.0;
constexpr double kLegendWidth = 300.0;
constexpr double kLabelSize = 12.0, kLabelRoom = 14.0;  // px

struct Style {
  const char* name;
  const char* color;
  const char* dash;
};
constexpr std::array<Style, 4> kPassStyles{{{"zig-zag passes", "#1f4e9c", ""},
                                            {"contour passes", "#9c2f1f", ""},
                                            {"crease passes", "#7a1fa2", ""},
                                            {"rest passes", "#00796b", ""}}};
constexpr Style kLinkStyle{"links and leads", "#e09000", "2,1.5"};
constexpr Style kRapidStyle{"rapids", "#d0208f", "4,3"};

// "#rrggbb" darkened by shade.
std::string Shade(const std::string& color, double shade) {
  int rgb[3] = {200, 200, 200};
  if (color.size() == 7 && color[0] == '#') {
    for (int k = 0; k < 3; ++k)
      rgb[k] = std::stoi(color.substr(static_cast<std::size_t>(1 + 2 * k), 2), nullptr, 16);
  }
  return fmt::format("#{:02x}{:02x}{:02x}", static_cast<int>(rgb[0] * shade),
                     static_cast<int>(rgb[1] * shade), static_cast<int>(rgb[2] * shade));
}

void DrawSurface(const PreviewInput& input, const View& view, LabelPlaces& places, SvgWriter& svg) {
  // Strokes as wide as this close the seams that smoothing leaves between facets.
  svg.OpenGroup("stroke-width=\"0.8\" stroke-linejoin=\"round\"");
  for (const Facet& f : MakeFacets(input, view)) {
    const bool known = f.region >= 0 && static_cast<std::size_t>(f.region) < input.regions.size();
    const std::string color =
        Shade(known ? input.regions[static_cast<std::size_t>(f.region)].color : "#d8d8d8", f.shade);
    std::array<Vec2, 4> points;
    for (std::size_t k = 0; k < 4; ++k) points[k] = view(f.corners[k]);
    svg.Polygon({points.begin(), points.end()}, fmt::format("fill=\"{0}\" stroke=\"{0}\"", color));
    places.Paint(points, f.region);
  }
  svg.CloseGroup();
}

// The regions' names where they show widest, white around them.
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

void DrawBorders(const PreviewInput& input, const SeenLines& seen, SvgWriter& svg) {
  svg.OpenGroup("fill=\"none\" stroke=\"#202020\" stroke-width=\"0.8\"");
  for (const PreviewRegion& region : input.regions) {
    if (region.unreachable) continue;
    for (std::vector<Vec3> loop : region.border) {
      if (!loop.empty()) loop.push_back(loop.front());
      seen.Draw(loop, svg);
    }
  }
  svg.CloseGroup();
}

void DrawOpenEdges(const PreviewInput& input, const SeenLines& seen, SvgWriter& svg) {
  constexpr int kSteps = 24;
  svg.OpenGroup("fill=\"none\" stroke=\"#000000\" stroke-width=\"1.6\"");
  const PatchNetwork& network = input.surface->network;
  for (const EdgeLink& link : network.edges) {
    if (link.neighbor || link.collapsed || link.on_t_junction) continue;
    const PatchShape& shape = network.model.patches[link.self.patch.index()].shape;
    std::vector<Vec3> points;
    for (int i = 0; i <= kSteps; ++i) {
      const Vec2 uv = EdgeParameters(shape, link.self.edge, static_cast<double>(i) / kSteps);
      points.push_back(Position(shape, uv.x(), uv.y()));
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

// Which of the six path styles a move is drawn in.
int StyleOf(const PreviewInput& input, const Move& move) {
  if (move.kind == MoveKind::kRapid) return 5;
  if (move.kind != MoveKind::kCut) return 4;
  const auto pass = static_cast<std::size_t>(std::max(0, move.pass));
  return pass < input.pass_kinds.size() ? static_cast<int>(input.pass_kinds[pass]) : 0;
}

// Moves of one style as polylines of tip positions, vertices closer than `apart` px dropped.
void DrawMoves(const PreviewInput& input, const View& view, int style, double apart, SvgWriter& svg) {
  const Toolpath& path = *input.toolpath;
  const Vec3 tip(0, 0, -path.ball_radius);
  const Style& s = style < 4    ? kPassStyles[static_cast<std::size_t>(style)]
                   : style == 4 ? kLinkStyle
                                : kRapidStyle;
  svg.OpenGroup(fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-opacity=\"{}\"{}",
                            s.color, style >= 4 ? 0.5 : 0.45, style == 5 ? 0.5 : 0.9,
                            *s.dash ? fmt::format(" stroke-dasharray=\"{}\"", s.dash) : std::string()));
  std::vector<Vec2> points;
  const auto flush = [&] {
    if (points.size() > 1) svg.Polyline(points, "");
    points.clear();
  };
  for (std::size_t i = 1; i < path.moves.size(); ++i) {
    if (StyleOf(input, path.moves[i]) != style) {
      flush();
      continue;
    }
    if (points.empty()) points.push_back(view(path.moves[i - 1].to + tip));
    const Vec2 q = view(path.moves[i].to + tip);
    const bool last = i + 1 == path.moves.size() || StyleOf(input, path.moves[i + 1]) != style;
    if (last || (q - points.back()).norm() >= apart) points.push_back(q);
  }
  flush();
  svg.CloseGroup();
}

// The round length nearest to a sixth of the view.
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

void DrawLegend(const PreviewInput& input, double x, SvgWriter& svg) {
  double y = kHead;
  const auto row = [&](const std::string& color, const char* dash, bool area, const std::string& text) {
    if (area) {
      svg.Rect({x, y - 9}, 14, 11, fmt::format("fill=\"{}\" stroke=\"#555\" stroke-width=\"0.5\"", color));
    } else {
      svg.Line({x, y - 4}, {x + 22, y - 4},
               fmt::format("stroke=\"{}\" stroke-width=\"2\"{}", color,
                           *dash ? fmt::format(" stroke-dasharray=\"{}\"", dash) : ""));
    }
    svg.Text({x + 30, y}, 11, text);
    y += 17;
  };
  if (!input.regions.empty()) {
    svg.Text({x, y}, 13, "regions", "font-weight=\"bold\"");
    y += 19;
  }
  constexpr std::size_t kMaxRows = 24;
  for (std::size_t i = 0; i < std::min(kMaxRows, input.regions.size()); ++i) {
    row(input.regions[i].color, "", true, input.regions[i].name);
  }
  if (input.regions.size() > kMaxRows) {
    svg.Text({x + 30, y}, 11, fmt::format("and {} more", input.regions.size() - kMaxRows));
    y += 17;
  }
  y += 8;
  svg.Text({x, y}, 13, "lines", "font-weight=\"bold\"");
  y += 19;
  row("#000000", "", false, "open edges of the sheet");
  if (!input.regions.empty()) row("#202020", "", false, "region borders");
  for (std::size_t i = 0; i < std::min(kMaxRows, input.lines.size()); ++i) {
    row(input.lines[i].color, "", false, input.lines[i].name);
  }
  if (input.lines.size() > kMaxRows) {
    svg.Text({x + 30, y}, 11, fmt::format("and {} more", input.lines.size() - kMaxRows));
    y += 17;
  }
  if (input.toolpath == nullptr) return;
  std::array<bool, 6> used{};
  for (std::size_t i = 1; i < input.toolpath->moves.size(); ++i) {
    used[static_cast<std::size_t>(StyleOf(input, input.toolpath->moves[i]))] = true;
  }
  for (std::size_t k = 0; k < 4; ++k) {
    if (used[k]) row(kPassStyles[k].color, kPassStyles[k].dash, false, kPassStyles[k].name);
  }
  if (used[4]) row(kLinkStyle.color, kLinkStyle.dash, false, kLinkStyle.name);
  if (used[5]) row(kRapidStyle.color, kRapidStyle.dash, false, kRapidStyle.name);
}

}  // namespace

std::string DrawPreview(const PreviewInput& input, std::size_t max_bytes) {
  Box3 box = input.surface->box;
  if (input.toolpath != nullptr) {  // centres run up to a radius beside the part, leads a little more
    const double beside = 1.5 * input.toolpath->ball_radius;
    box.min -= Vec3(beside, beside, 0);
    box.max += Vec3(beside, beside, 0);
  }
  const double legend_x = 3 * kMargin + 2 * kViewSize;
  const double height = kHead + kViewSize + 2 * kMargin;
  SvgWriter svg(legend_x + kLegendWidth, height);
  svg.Rect({0, 0}, legend_x + kLegendWidth, height, "fill=\"#ffffff\"");
  svg.Text({kMargin, 26}, 18, input.title, "font-weight=\"bold\"");
  for (std::size_t i = 0; i < input.notes.size() && i < 2; ++i)
    svg.Text({kMargin, 44 + 15.0 * static_cast<double>(i)}, 12, input.notes[i]);

  const std::array<View, 2> views = {
      FitView(TopView(), box, {kMargin, kHead + 10}, kViewSize, kViewSize - 30),
      FitView(IsometricView(), box, {2 * kMargin + kViewSize, kHead + 10}, kViewSize, kViewSize - 30)};
  for (std::size_t k = 0; k < views.size(); ++k) {
    const double side = static_cast<double>(k) * (kMargin + kViewSize);
    LabelPlaces places({kMargin + side, kHead + 10}, {kViewSize, kViewSize});
    DrawSurface(input, views[k], places, svg);
    const SeenLines seen(*input.surface, views[k], {kMargin + side, kHead + 10}, {kViewSize, kViewSize},
                         2 * FacetsPerSide(*input.surface));
    DrawBorders(input, seen, svg);
    DrawOpenEdges(input, seen, svg);
    DrawLines(input, seen, svg);
    if (input.toolpath == nullptr) DrawLabels(input, places, svg);
  }
  if (input.toolpath != nullptr) {
    // 14 bytes a vertex; the distance between drawn vertices grows until both views fit.
    const std::size_t left = max_bytes > svg.size() ? max_bytes - svg.size() : 0;
    const double vertices = 2.0 * static_cast<double>(input.toolpath->moves.size());
    const double apart =
        std::clamp(0.5 * 14.0 * vertices / std::max(1.0, static_cast<double>(left)), 0.6, 12.0);
    for (const View& view : views) {
      for (const int style : {5, 4, 0, 1, 2, 3}) DrawMoves(input, view, style, apart, svg);
    }
  }
  for (const View& view : views) {
    const Vec2 zero = view(input.program_zero);
    svg.Line(zero - Vec2(7, 0), zero + Vec2(7, 0), "stroke=\"#d00000\" stroke-width=\"1.2\"");
    svg.Line(zero - Vec2(0, 7), zero + Vec2(0, 7), "stroke=\"#d00000\" stroke-width=\"1.2\"");
  }
  const double foot = kHead + kViewSize + kMargin;
  DrawScale(views[0], {kMargin, foot}, svg);
  svg.Text({kMargin + 200, foot + 4}, 12, "from above; red cross: program zero");
  DrawScale(views[1], {2 * kMargin + kViewSize, foot}, svg);
  svg.Text({2 * kMargin + kViewSize + 200, foot + 4}, 12, "isometric");
  DrawLegend(input, legend_x, svg);
  return std::move(svg).Finish();
}

}  // namespace patchmill
