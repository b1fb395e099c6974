#include "cam/picture/legend.h"

#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "cam/picture/move_lines.h"

namespace patchmill {
namespace {

constexpr std::size_t kMaxRows = 24;  // for regions, and as many for lines
constexpr double kRow = 17.0;         // px, height of a row

class Legend {
 public:
  Legend(const Vec2& corner, SvgWriter& svg) : at_(corner), svg_(svg) {}

  void Heading(const std::string& text) {
    svg_.Text(at_, 13, text, "font-weight=\"bold\"");
    at_.y() += 19;
  }
  void Area(const std::string& color, const std::string& text) {
    svg_.Rect(at_ - Vec2(0, 9), 14, 11,
              fmt::format("fill=\"{}\" stroke=\"#555\" stroke-width=\"0.5\"", color));
    Text(text);
  }
  void Line(const std::string& color, const char* dash, const std::string& text) {
    svg_.Line(at_ - Vec2(0, 4), at_ + Vec2(22, -4),
              fmt::format("stroke=\"{}\" stroke-width=\"2\"{}", color,
                          *dash ? fmt::format(" stroke-dasharray=\"{}\"", dash) : ""));
    Text(text);
  }
  void Dot(const std::string& text) {
    DrawNode(at_ + Vec2(11, -4), svg_);
    Text(text);
  }
  // Draws a strip of the colours color(0) to color(1), with texts at its ends and one at `share`.
  template <typename Color>
  void Scale(const Color& color, const std::string& from, double share, const std::string& middle,
             const std::string& to) {
    constexpr int kParts = 60;        // rectangles of one colour
    constexpr double kWidth = 240.0;  // px
    for (int i = 0; i < kParts; ++i) {
      svg_.Rect(at_ + Vec2(kWidth * i / kParts, -9), kWidth / kParts + 0.3, 11,
                fmt::format("fill=\"{}\"", color((i + 0.5) / kParts)));
    }
    at_.y() += 15;
    svg_.Text(at_, 11, from);
    svg_.Text(at_ + Vec2(share * kWidth, 0), 11, middle, "text-anchor=\"middle\"");
    svg_.Text(at_ + Vec2(kWidth, 0), 11, to, "text-anchor=\"end\"");
    at_.y() += kRow;
  }
  void More(std::size_t count) {
    if (count > kMaxRows) Text(fmt::format("and {} more", count - kMaxRows));
  }
  void Note(const std::string& text) { Text(text); }
  void Gap() { at_.y() += 8; }

 private:
  void Text(const std::string& text) {
    svg_.Text(at_ + Vec2(30, 0), 11, text);
    at_.y() += kRow;
  }

  Vec2 at_;
  SvgWriter& svg_;
};

// The indices of the largest regions, as many as there are rows, in rising order.
std::vector<std::size_t> RowsOf(const std::vector<PreviewRegion>& regions) {
  std::vector<std::size_t> rows(regions.size());
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  std::stable_sort(rows.begin(), rows.end(),
                   [&](std::size_t a, std::size_t b) { return regions[a].area > regions[b].area; });
  rows.resize(std::min(kMaxRows, rows.size()));
  std::sort(rows.begin(), rows.end());
  return rows;
}

void AddMoves(const PreviewInput& input, Legend& legend) {
  EnumArray<MoveLine, bool> used{};
  for (std::size_t i = 1; i < input.toolpath->moves.size(); ++i)
    used[LineOf(input, input.toolpath->moves[i])] = true;
  for (const MoveLine line : Enumerators<MoveLine>()) {
    const MoveStyle& style = kMoveStyles[line];
    if (used[line]) legend.Line(style.color, style.dash, style.name);
  }
  if (!input.section_passes.empty()) legend.Note("1, 2, ...: where sections start; arrows: direction");
}

void AddScales(const PaintScales& scales, Legend& legend) {
  legend.Gap();
  legend.Heading("slope");
  legend.Scale([&](double share) { return SlopeColor(0.5 * kPi * share, scales); }, "level",
               scales.steep_angle / (0.5 * kPi), fmt::format("{:g}\u00b0", Degrees(scales.steep_angle)),
               "upright");
  legend.Heading("curvature of contours, 1/mm");
  const double most = 1.0 / scales.radius;
  legend.Scale([&](double share) { return CurvatureColor((2.0 * share - 1.0) * most, scales); },
               fmt::format("-{:.3g} outward", most), 0.5, "0", fmt::format("inward {:.3g}", most));
}

}  // namespace

void DrawNode(const Vec2& at, SvgWriter& svg) {
  constexpr double kRadius = 2.6;  // px
  svg.Circle(at, kRadius, "fill=\"#ffffff\" stroke=\"#202020\" stroke-width=\"1\"");
}

void DrawLegend(const PreviewInput& input, const Vec2& corner, SvgWriter& svg) {
  Legend legend(corner, svg);
  if (!input.regions.empty()) {
    legend.Heading(input.region_title);
    for (const std::size_t i : RowsOf(input.regions))
      legend.Area(input.regions[i].color, input.regions[i].name);
    legend.More(input.regions.size());
    legend.Gap();
  }
  if (!input.borders.empty()) {
    legend.Heading("borders of " + input.region_title);
    for (const PreviewLines& lines : input.borders) legend.Line(lines.color, "", lines.name);
    if (!input.nodes.empty()) legend.Dot(fmt::format("nodes: {}", input.nodes.size()));
    legend.Gap();
  }
  legend.Heading("lines");
  legend.Line("#000000", "", "open edges of the sheet");
  for (std::size_t i = 0; i < std::min(kMaxRows, input.lines.size()); ++i)
    legend.Line(input.lines[i].color, "", input.lines[i].name);
  legend.More(input.lines.size());
  if (input.toolpath != nullptr) AddMoves(input, legend);
  if (input.shadings) AddScales(input.scales, legend);
}

}  // namespace patchmill
