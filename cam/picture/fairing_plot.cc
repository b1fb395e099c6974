#include "cam/picture/fairing_plot.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "cam/picture/svg_writer.h"
#include "cam/picture/view.h"

namespace patchmill {
namespace {

constexpr double kWidth = 1000.0, kPanelHeight = 360.0;  // px
constexpr double kMargin = 30.0, kLineHeight = 17.0;     // px
constexpr double kToothRoom = 0.25;      // of the panel's height: room for teeth on either side of the curve
constexpr double kTypicalTooth = 0.08;   // of the panel's height: length of a typical tooth, which scales all
constexpr double kTypicalShare = 0.9;    // share of the teeth before fairing that are no longer than typical
constexpr double kCurveTolerance = 0.2;  // px, sagitta of the drawn curve
constexpr double kMaxCurvePoints = 150'000;  // of a curve with more points only the nodes are drawn

// The view along the axis in which the box is least extended.
View PlaneView(const Box3& box) {
  const Vec3 extent = box.max - box.min;
  View view;
  if (extent.x() < std::min(extent.y(), extent.z())) {
    view.right = Vec3::UnitY(), view.up = Vec3::UnitZ(), view.toward = Vec3::UnitX();
  } else if (extent.y() < extent.z()) {
    view.right = Vec3::UnitX(), view.up = Vec3::UnitZ(), view.toward = -Vec3::UnitY();
  }
  return view;
}

struct Tooth {
  Vec3 foot = Vec3::Zero();
  Vec3 out = Vec3::Zero();  // unit, in the view's plane, away from the centre of curvature
  double curvature = 0.0;   // 1/mm, >= 0, of the projection
};

std::vector<Tooth> Comb(const Beam& beam, const View& view) {
  const int per_segment = std::clamp(kMaxCombTeeth / beam.count(), 1, 8);
  const int stride = std::max(1, beam.count() / kMaxCombTeeth + (beam.count() % kMaxCombTeeth != 0 ? 1 : 0));
  std::vector<Tooth> comb;
  for (int i = 0; i + 1 < beam.count(); i += stride) {
    const BeamSegment segment = Segment(beam, i);
    for (int k = 0; k < per_segment; ++k) {
      const double t = static_cast<double>(k) / per_segment;
      const Vec3 d = segment.Derivative(t), dd = segment.Second(t);
      const Vec2 flat(view.right.dot(d), view.up.dot(d)), bend(view.right.dot(dd), view.up.dot(dd));
      const double speed = flat.norm();
      if (!(speed > 1e-9 * d.norm())) continue;
      const double curvature = Cross(flat, bend) / (speed * speed * speed);
      const Vec2 right(flat.y() / speed, -flat.x() / speed);  // points away from the centre of a left turn
      const Vec2 out = curvature >= 0.0 ? right : Vec2(-right);
      comb.push_back({segment.Point(t), out.x() * view.right + out.y() * view.up, std::abs(curvature)});
    }
  }
  return comb;
}

double TypicalCurvature(std::vector<Tooth> comb) {
  if (comb.empty()) return 0.0;
  const auto at =
      comb.begin() + static_cast<std::ptrdiff_t>(kTypicalShare * static_cast<double>(comb.size() - 1));
  std::nth_element(comb.begin(), at, comb.end(),
                   [](const Tooth& a, const Tooth& b) { return a.curvature < b.curvature; });
  return at->curvature;
}

void DrawCurve(SvgWriter& svg, const Beam& beam, const View& view, double px_per_curvature,
               const char* color) {
  std::vector<Vec2> tips;
  svg.OpenGroup(fmt::format("stroke=\"{}\" stroke-width=\"0.5\" fill=\"none\"", color));
  for (const Tooth& tooth : Comb(beam, view)) {
    const double length = std::min(tooth.curvature * px_per_curvature, kToothRoom * kPanelHeight);
    const Vec2 foot = view(tooth.foot);
    tips.push_back(view(tooth.foot + length / view.scale * tooth.out));
    svg.Line(foot, tips.back(), "");
  }
  svg.Polyline(tips, "stroke-width=\"0.8\"");
  svg.CloseGroup();
  const double tolerance = kCurveTolerance / view.scale;
  const bool fits = PolylineSize(beam, tolerance) <= kMaxCurvePoints;
  std::vector<Vec2> line;
  for (const Vec3& p : fits ? Polyline(beam, tolerance) : beam.points) line.push_back(view(p));
  svg.Polyline(line, "stroke=\"#202020\" stroke-width=\"1.2\" fill=\"none\"");
}

}  // namespace

std::string DrawFairing(const FairingPlot& plot) {
  Box3 box;
  for (const Beam* beam : {plot.before, plot.after}) {
    for (const Vec3& p : beam->points) box.Add(p);
  }
  const double head = kMargin + kLineHeight * static_cast<double>(plot.notes.size() + 1);
  const double height = head + 2.0 * (kPanelHeight + kLineHeight) + kMargin;
  SvgWriter svg(kWidth, height);
  svg.Rect({0, 0}, kWidth, height, "fill=\"#ffffff\"");
  svg.Text({kMargin, kMargin}, 16, plot.title, "font-weight=\"bold\"");
  for (std::size_t k = 0; k < plot.notes.size(); ++k) {
    svg.Text({kMargin, kMargin + kLineHeight * static_cast<double>(k + 1)}, 12, plot.notes[k]);
  }
  const double room = kToothRoom * kPanelHeight;
  double px_per_curvature = 0.0;
  const struct {
    const Beam* beam;
    const char* name;
    const char* color;
  } panels[] = {{plot.before, "before", "#c0392b"}, {plot.after, "after", "#1f4e9c"}};
  double top = head;
  for (const auto& panel : panels) {
    svg.Text({kMargin, top + kLineHeight}, 13, panel.name);
    const View view = FitView(PlaneView(box), box, {kMargin + room, top + kLineHeight + room},
                              kWidth - 2.0 * (kMargin + room), kPanelHeight - 2.0 * room);
    if (panel.beam == plot.before) {
      const double typical = TypicalCurvature(Comb(*panel.beam, view));
      px_per_curvature = typical > 0.0 ? kTypicalTooth * kPanelHeight / typical : 0.0;
    }
    DrawCurve(svg, *panel.beam, view, px_per_curvature, panel.color);
    top += kPanelHeight + kLineHeight;
  }
  return std::move(svg).Finish();
}

}  // namespace patchmill
