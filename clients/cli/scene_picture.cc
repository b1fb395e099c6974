#include "clients/cli/scene_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "clients/cli/picture_legend.h"
#include "clients/cli/picture_path.h"
#include "clients/cli/picture_shading.h"
#include "clients/cli/scene_bodies.h"
#include "clients/cli/scene_words.h"
#include "clients/render/canvas.h"

namespace patchmill::cli {
namespace {

using render::Camera;
using render::Canvas;
using render::FromHex;
using render::LineStyle;
using render::Point;
using render::Project;
using render::Rgb;
using render::Seen;

constexpr const char* kStockColor = "#8c7a5b";
constexpr const char* kClampColor = "#8d97a5";
constexpr int kSamples = 2;  // pixels are drawn at twice their number and averaged

double Dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// How bright a surface is under a lamp at the eye and one behind the left shoulder, as in the 3-D page.
// Both sides are lit alike; what is seen from behind is darker.
double LightOf(const Camera& camera, const Point& normal) {
  const double length = std::sqrt(Dot(normal, normal));
  if (!(length > 0.0)) return 0.46;
  double x = Dot(normal, camera.right) / length, y = Dot(normal, camera.up) / length,
         z = Dot(normal, camera.back) / length;
  const bool behind = z < 0.0;
  if (behind) x = -x, y = -y, z = -z;
  const double lamp =
      std::max(0.0, (-0.45 * x + 0.75 * y + 0.5 * z) / std::sqrt(0.45 * 0.45 + 0.75 * 0.75 + 0.25));
  return (0.46 + 0.36 * z + 0.24 * lamp) * (behind ? 0.82 : 1.0);
}

struct Vertex {
  Seen seen;
  double light = 0.0;
};

std::vector<Vertex> VerticesOf(const v1::MeshBlock& block, const Camera& camera) {
  std::vector<Vertex> vertices(static_cast<std::size_t>(block.position_mm_size() / 3));
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    const int at = static_cast<int>(3 * v);
    const Point position = {block.position_mm(at), block.position_mm(at + 1), block.position_mm(at + 2)};
    const Point normal = {block.normal(at), block.normal(at + 1), block.normal(at + 2)};
    vertices[v] = {Project(camera, position), LightOf(camera, normal)};
  }
  return vertices;
}

// How much a value that is linear in a triangle changes from a pixel to the next at most.
double StepOf(const render::Triangle& t, const std::array<double, 3>& values) {
  const double ux = t[1].x - t[0].x, uy = t[1].y - t[0].y, vx = t[2].x - t[0].x, vy = t[2].y - t[0].y;
  const double area = ux * vy - uy * vx;
  if (area == 0.0) return 0.0;
  const double du = values[1] - values[0], dv = values[2] - values[0];
  return (std::abs(du * vy - dv * uy) + std::abs(dv * ux - du * vx)) / std::abs(area);
}

void DrawBlock(const v1::MeshBlock& block, const Shading& shading, const Camera& camera, Canvas& canvas) {
  const std::vector<Vertex> vertices = VerticesOf(block, camera);
  const std::vector<float> values =
      shading.scale ? ValuesOf(block, shading.scale->value) : std::vector<float>();
  for (int t = 0; t < block.region_id_size(); ++t) {
    std::array<std::size_t, 3> corner;
    render::Triangle triangle;
    std::array<double, 3> light;
    for (int k = 0; k < 3; ++k) {
      const auto at = static_cast<std::size_t>(k);
      corner[at] = static_cast<std::size_t>(block.corners(3 * t + k));
      triangle[at] = vertices[corner[at]].seen;
      light[at] = vertices[corner[at]].light;
    }
    const auto lit = [&](double a, double b, double c) { return a * light[0] + b * light[1] + c * light[2]; };
    if (!shading.scale) {
      const auto found = shading.of_region.find(block.region_id(t));
      const Rgb color = found != shading.of_region.end() ? found->second : shading.of_region.at(-1);
      canvas.FillTriangle(triangle, [&](double a, double b, double c) { return Lit(color, lit(a, b, c)); });
      continue;
    }
    std::array<double, 3> value;
    for (std::size_t k = 0; k < 3; ++k)
      value[k] = values.empty() ? std::numeric_limits<double>::quiet_NaN() : double{values[corner[k]]};
    const double mark = shading.scale->mark.value_or(std::numeric_limits<double>::quiet_NaN());
    const double near_mark = 0.8 * kSamples * StepOf(triangle, value);
    canvas.FillTriangle(triangle, [&](double a, double b, double c) {
      const double here = a * value[0] + b * value[1] + c * value[2];
      const bool marked = std::abs(here - mark) < near_mark;
      // The legend is read by its colours, so the light changes them little.
      const double light_here = 0.78 + 0.22 * std::min(1.0, lit(a, b, c));
      return Lit(marked ? Rgb{18, 18, 18} : ColorAt(shading.scale->scale, here), light_here);
    });
  }
}

double AreaOf(const std::vector<v1::MeshBlock>& mesh) {
  double sum = 0.0;
  for (const v1::MeshBlock& block : mesh) {
    const auto point = [&](int corner) {
      const int v = 3 * block.corners(corner);
      return Point{block.position_mm(v), block.position_mm(v + 1), block.position_mm(v + 2)};
    };
    for (int t = 0; t + 2 < block.corners_size(); t += 3) {
      const Point a = point(t), b = point(t + 1), c = point(t + 2);
      const Point u = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, v = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
      sum +=
          0.5 * std::hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]);
    }
  }
  return sum;
}

void DrawBorders(const v1::RegionMap& map, const Camera& camera, double nearer, Canvas& canvas) {
  for (const v1::BorderLine& line : map.border_lines()) {
    const LineStyle style{Lit(FromHex(BorderColor(line.kind())), 0.8), 3, nearer};
    const auto& points = line.points_mm();
    const int count = points.size() / 3;
    const auto seen = [&](int k) {
      return Project(camera, {points[3 * k], points[3 * k + 1], points[3 * k + 2]});
    };
    for (int k = 0; k + 1 < count + (line.closed() ? 1 : 0); ++k)
      canvas.DrawLine(seen(k), seen((k + 1) % count), style);
  }
}

bool IsShown(const PictureOptions& options, std::uint8_t path_class) {
  const auto has = [&](const char* layer) {
    return std::find(options.layers.begin(), options.layers.end(), layer) != options.layers.end();
  };
  if (path_class == kRapid) return has("rapids");
  return path_class >= kCutOfNoPass ? has("passes") : has("links");
}

// Draws the path and returns the classes that are in the picture.
std::vector<std::uint8_t> DrawPath(const PicturePath& path, const PictureOptions& options,
                                   const Camera& camera, double nearer, Canvas& canvas) {
  const std::vector<std::uint8_t> least = LeastRanks(path, camera.pixel_mm * kSamples);
  std::map<std::uint8_t, bool> shown;
  for (std::size_t k = 1; k < path.points.size(); ++k) {
    const PathPoint& point = path.points[k];
    if (!IsShown(options, point.path_class)) continue;
    shown[point.path_class] = true;
    if (point.rank < least[point.path_class]) continue;
    canvas.DrawLine(Project(camera, path.points[k - 1].tip), Project(camera, point.tip),
                    {PathColor(point.path_class), 2, nearer});
  }
  std::vector<std::uint8_t> classes;
  for (const auto& [path_class, drawn] : shown) classes.push_back(path_class);
  return classes;
}

void DrawPrism(const Prism& prism, const Camera& camera, Rgb color, double opacity, Canvas& canvas) {
  const std::size_t count = prism.outline.size();
  if (count < 3) return;
  const auto at = [&](std::size_t k, double z) {
    const auto& [x, y] = prism.outline[k % count];
    return Project(camera, {x, y, z});
  };
  std::vector<Seen> top, bottom;
  const LineStyle edge{opacity < 1.0 ? color : FromHex("#3b4149"), 2, 2.0 * camera.pixel_mm};
  for (std::size_t k = 0; k < count; ++k) {
    top.push_back(at(k, prism.top));
    bottom.push_back(at(k, prism.bottom));
    const auto& [ax, ay] = prism.outline[k];
    const auto& [bx, by] = prism.outline[(k + 1) % count];
    const double light = LightOf(camera, {by - ay, ax - bx, 0.0});
    canvas.DrawPolygon({at(k, prism.bottom), at(k + 1, prism.bottom), at(k + 1, prism.top), at(k, prism.top)},
                       Lit(color, light), opacity);
  }
  canvas.DrawPolygon(top, Lit(color, LightOf(camera, {0.0, 0.0, 1.0})), opacity);
  canvas.DrawPolygon(bottom, Lit(color, LightOf(camera, {0.0, 0.0, -1.0})), opacity);
  for (std::size_t k = 0; k < count; ++k) {
    canvas.DrawLine(top[k], top[(k + 1) % count], edge);
    canvas.DrawLine(bottom[k], bottom[(k + 1) % count], edge);
    // A round outline has no upright edges.
    const auto& [ax, ay] = prism.outline[(k + count - 1) % count];
    const auto& [bx, by] = prism.outline[k];
    const auto& [cx, cy] = prism.outline[(k + 1) % count];
    const double turn = std::atan2((bx - ax) * (cy - by) - (by - ay) * (cx - bx),
                                   (bx - ax) * (cx - bx) + (by - ay) * (cy - by));
    if (std::abs(turn) > 0.35) canvas.DrawLine(top[k], bottom[k], edge);
  }
}

// Draws a profile turned about the axis of the tool, with its tip in `tip`.
void DrawTurned(const Profile& profile, const Point& tip, const Camera& camera, Rgb color, Canvas& canvas) {
  constexpr int kSides = 60;
  const auto point = [&](const std::pair<double, double>& p, int side) {
    const double angle = 2.0 * std::numbers::pi * side / kSides;
    return Project(
        camera, {tip[0] + p.second * std::cos(angle), tip[1] + p.second * std::sin(angle), tip[2] + p.first});
  };
  for (std::size_t k = 0; k + 1 < profile.size(); ++k) {
    const auto& low = profile[k];
    const auto& high = profile[k + 1];
    for (int side = 0; side < kSides; ++side) {
      const double angle = 2.0 * std::numbers::pi * (side + 0.5) / kSides;
      const double outward = high.first - low.first, upward = low.second - high.second;
      const double light = LightOf(camera, {outward * std::cos(angle), outward * std::sin(angle), upward});
      const Rgb lit = Lit(color, light);
      const auto paint = [&](double, double, double) { return lit; };
      canvas.FillTriangle({point(low, side), point(low, side + 1), point(high, side + 1)}, paint);
      canvas.FillTriangle({point(low, side), point(high, side + 1), point(high, side)}, paint);
    }
  }
}

// Where the first pass begins; the first point of a path without passes.
std::optional<Point> StartOfPasses(const PicturePath& path) {
  for (std::size_t k = 1; k < path.points.size(); ++k)
    if (path.points[k].path_class >= kCutOfNoPass) return path.points[k - 1].tip;
  if (path.points.empty()) return std::nullopt;
  return path.points.front().tip;
}

// Adds the corners of what is drawn, so that the picture can hold them.
void Include(const std::vector<v1::MeshBlock>& mesh, std::vector<Point>& points) {
  for (const v1::MeshBlock& block : mesh) {
    for (int k = 0; k + 2 < block.position_mm_size(); k += 3)
      points.push_back({block.position_mm(k), block.position_mm(k + 1), block.position_mm(k + 2)});
  }
}

void Include(const Prism& prism, std::vector<Point>& points) {
  for (const auto& [x, y] : prism.outline) {
    points.push_back({x, y, prism.bottom});
    points.push_back({x, y, prism.top});
  }
}

void Include(const ToolProfiles& tool, const Point& tip, std::vector<Point>& points) {
  for (const Profile* profile : {&tool.flutes, &tool.shank, &tool.holder}) {
    for (const auto& [height, radius] : *profile) {
      for (const double x : {-radius, radius})
        for (const double y : {-radius, radius}) points.push_back({tip[0] + x, tip[1] + y, tip[2] + height});
    }
  }
}

bool Has(const PictureOptions& options, const char* layer) {
  return std::find(options.layers.begin(), options.layers.end(), layer) != options.layers.end();
}

}  // namespace

std::vector<std::string> LayerNames() {
  return {"passes", "links", "rapids", "borders", "stock", "clamps", "tool"};
}

absl::StatusOr<std::string> MakePicture(const Scene& scene, const PictureOptions& options) {
  if (scene.mesh.empty()) return absl::DataLossError("the answer has no triangles; no picture was written");
  if (const absl::Status whole = CheckArrays(scene); !whole.ok()) return whole;
  const char* const usual = scene.regions.regions().empty() ? "leftover" : "region";
  absl::StatusOr<Shading> shading = MakeShading(scene, options.shading.empty() ? usual : options.shading);
  if (!shading.ok()) return shading.status();

  const render::Box part = BoxOf(scene.mesh);
  const double chord = std::max(
      0.5 * scene.tolerance,
      std::hypot(part.max[0] - part.min[0], part.max[1] - part.min[1], part.max[2] - part.min[2]) / 20'000.0);
  const PicturePath path = MakePicturePath(scene.paths, chord, AreaOf(scene.mesh));
  const std::optional<Prism> stock = Has(options, "stock") ? StockOf(scene, part) : std::nullopt;
  const std::vector<Prism> clamps =
      Has(options, "clamps") ? ClampsOf(scene.setup, part.min[2]) : std::vector<Prism>();
  const ToolProfiles tool = ProfilesOf(scene.tool);
  const std::optional<Point> tip = Has(options, "tool") ? StartOfPasses(path) : std::nullopt;
  std::vector<Point> points;
  Include(scene.mesh, points);
  if (stock) Include(*stock, points);
  for (const Prism& clamp : clamps) Include(clamp, points);
  for (std::size_t k = 1; k < path.points.size(); ++k)
    if (IsShown(options, path.points[k].path_class)) points.push_back(path.points[k].tip);
  if (tip) Include(tool, *tip, points);

  const LegendPlace place = PlaceOfLegend(options.size);
  const render::PixelSize drawn = {kSamples * place.left_px, kSamples * options.size.height};
  const Camera camera = FitPoints(options.view, points, drawn);
  Canvas canvas(drawn, FromHex("#f3f5f7"));
  for (const v1::MeshBlock& block : scene.mesh) DrawBlock(block, *shading, camera, canvas);
  for (const Prism& clamp : clamps) DrawPrism(clamp, camera, FromHex(kClampColor), 1.0, canvas);
  // Lines on the surface lie up to this much below its triangles, or are as near as a few pixels.
  const double nearer = 3.0 * camera.pixel_mm + 2.0 * scene.tolerance;
  if (Has(options, "borders")) DrawBorders(scene.regions, camera, nearer, canvas);
  const std::vector<std::uint8_t> path_classes = DrawPath(path, options, camera, nearer, canvas);
  if (tip) {
    DrawTurned(tool.flutes, *tip, camera, FromHex("#d9a441"), canvas);
    DrawTurned(tool.shank, *tip, camera, FromHex("#b9c0c8"), canvas);
    DrawTurned(tool.holder, *tip, camera, FromHex("#6f7a87"), canvas);
  }
  if (stock) DrawPrism(*stock, camera, FromHex(kStockColor), 0.13, canvas);

  Legend legend;
  legend.title = scene.title;
  legend.part = part;
  legend.tool = scene.tool;
  legend.outcome = scene.report.outcome();
  legend.shading = *std::move(shading);
  for (const std::uint8_t path_class : path_classes)
    legend.lines.push_back({PathColor(path_class), PathName(path_class)});
  if (Has(options, "borders")) {
    std::map<v1::BorderKind, bool> kinds;
    for (const v1::BorderLine& line : scene.regions.border_lines()) kinds[line.kind()] = true;
    for (const auto& [kind, drawn_too] : kinds)
      legend.lines.push_back({Lit(FromHex(BorderColor(kind)), 0.8), "border: " + BorderName(kind)});
  }
  if (stock) legend.lines.push_back({FromHex(kStockColor), stock->name});
  for (const Prism& clamp : clamps) legend.lines.push_back({FromHex(kClampColor), clamp.name});
  if (tip) legend.lines.push_back({FromHex("#d9a441"), "tool"});
  if (tip && !tool.holder.empty()) legend.lines.push_back({FromHex("#6f7a87"), "holder"});
  legend.view = ViewName(options.view);
  Camera seen = camera;
  seen.pixel_mm = camera.pixel_mm * kSamples;
  seen.size = {place.left_px, options.size.height};
  return render::WritePng(WithLegend(canvas.Halved(), seen, legend, options.size));
}

absl::StatusOr<std::string> MakePreview(const Scene& scene, const OutputFile& file,
                                        const PictureOptions& options) {
  return file.EndsIn(".html") ? MakePage(scene) : MakePicture(scene, options);
}

}  // namespace patchmill::cli
