#include "clients/cli/limit_options.h"

#include <cmath>
#include <sstream>

#include <fmt/format.h>

#include "clients/cli/input_file.h"
#include "clients/cli/job_options.h"
#include "clients/cli/text.h"

namespace patchmill::cli {
namespace {

// Reads "X,Y X,Y X,Y" into packed x y.
absl::Status ReadPoints(const std::string& text, const std::string& what,
                        google::protobuf::RepeatedField<double>* xy) {
  std::istringstream in(text);
  std::string point;
  while (in >> point) {
    const std::size_t comma = point.find(',');
    double x = 0.0, y = 0.0;
    if (comma == std::string::npos || !ReadFinite(point.substr(0, comma), x) ||
        !ReadFinite(point.substr(comma + 1), y)) {
      return absl::InvalidArgumentError(
          fmt::format("{}: \"{}\"; must be points X,Y separated by spaces", what, point.substr(0, 50)));
    }
    xy->Add(x);
    xy->Add(y);
  }
  if (xy->size() < 6) {
    return absl::InvalidArgumentError(
        fmt::format("{} has {} points; must have at least 3", what, xy->size() / 2));
  }
  return absl::OkStatus();
}

// Reads "[NAME=]TOP[,MARGIN]: POINTS".
absl::Status ReadObstacle(const std::string& text, v1::Obstacle& obstacle) {
  const std::size_t colon = text.find(':');
  std::string head = text.substr(0, colon);
  if (const std::size_t equals = head.find('='); equals != std::string::npos) {
    obstacle.set_id(WireText(head.substr(0, equals), 200));
    head = head.substr(equals + 1);
  }
  const std::size_t comma = head.find(',');
  double top = 0.0, margin = 0.0;
  if (colon == std::string::npos || !ReadFinite(head.substr(0, comma), top) ||
      (comma != std::string::npos && !ReadFinite(head.substr(comma + 1), margin))) {
    return absl::InvalidArgumentError(
        fmt::format("--obstacle \"{}\"; must be [NAME=]TOP[,MARGIN]: X,Y X,Y X,Y", text.substr(0, 80)));
  }
  obstacle.set_top_z_mm(top);
  obstacle.set_margin_mm(margin);
  const std::size_t points = text.find_first_not_of(' ', colon + 1);
  return ReadRing(points == std::string::npos ? "" : text.substr(points), "--obstacle",
                  obstacle.mutable_outline_xy_mm());
}

v1::BoundaryMode MakeMode(const std::string& name) {
  if (name == "contact") return v1::BOUNDARY_MODE_CONTACT;
  if (name == "inside") return v1::BOUNDARY_MODE_INSIDE;
  if (name == "outside") return v1::BOUNDARY_MODE_OUTSIDE;
  return v1::BOUNDARY_MODE_CENTER;
}

}  // namespace

absl::Status ReadRing(const std::string& text, const std::string& option,
                      google::protobuf::RepeatedField<double>* xy) {
  if (text.empty() || text.front() != '@') return ReadPoints(text, option, xy);
  absl::StatusOr<std::string> content = ReadWholeFile(text.substr(1));
  if (!content.ok()) return content.status();
  return ReadPoints(*content, text.substr(1), xy);
}

void AddLimitOptions(CLI::App& app, LimitOptions& options) {
  app.add_option("--only", options.only,
                 "cut only these, separated by commas: patches by id or #INDEX from #0; faces by id (f12, "
                 "face:f12; f12+ with smooth neighbours), name=, body=, layer=, color=#rrggbb, kind=, "
                 "radius<=MM, radius>=MM, joined by &")
      ->delimiter(',');
  app.add_option("--avoid", options.avoid, "do not cut these (check surfaces), named as by --only")
      ->delimiter(',');
  AddNumber(app, "--avoid-margin", options.avoid_margin, "distance between tool and avoided patches, mm");
  CLI::Option* boundary = app.add_option("--boundary", options.boundary,
                                         "containment: closed outline in plan, program frame, \"X,Y X,Y "
                                         "X,Y\" or @FILE; more of them: holes, islands");
  app.add_option("--boundary-mode", options.boundary_mode,
                 "what the boundary limits: contacts, tool axis, or the ball seen from above")
      ->check(CLI::IsMember({"contact", "center", "inside", "outside"}))
      ->needs(boundary)
      ->capture_default_str();
  AddNumber(app, "--boundary-offset", options.boundary_offset,
            "offset of the boundary, mm; > 0 widens it, < 0 narrows it");
  app.add_flag(
      "--outside", options.outside,
      "mill upright walls on the part's outer border, too; the tool goes down beside the part there");
  AddNumber(app, "--top", options.top, "highest tip of a cutting ball, mm, program frame");
  app.add_option("--obstacle", options.obstacles,
                 "a clamp or vice that the tool keeps off, to within half the tolerance, program frame: "
                 "\"[NAME=]TOP[,MARGIN]: X,Y X,Y X,Y\" or \"...: @FILE\"");
}

bool Selects(const LimitOptions& options) {
  return !options.only.empty() || !options.avoid.empty() || !options.boundary.empty() || options.outside;
}

absl::Status SetLimits(const LimitOptions& options, v1::Setup& setup, v1::Selection& selection) {
  // A user who sets one of these expects a limit. Without the other option there would be none.
  if (options.boundary.empty() && options.boundary_offset != 0.0)
    return absl::InvalidArgumentError("--boundary-offset is given without --boundary");
  if (options.avoid.empty() && options.avoid_margin != 0.0)
    return absl::InvalidArgumentError("--avoid-margin is given without --avoid");
  for (const std::string& text : options.obstacles) {
    if (const absl::Status read = ReadObstacle(text, *setup.add_obstacles()); !read.ok()) return read;
  }
  for (const std::string& id : options.only) selection.add_patch_ids(WireText(id, 200));
  for (const std::string& id : options.avoid) selection.add_avoid_patch_ids(WireText(id, 200));
  if (!options.avoid.empty()) selection.set_avoid_margin_mm(options.avoid_margin);
  if (options.outside) selection.set_mill_outside(true);
  for (std::size_t i = 0; i < options.boundary.size(); ++i) {
    auto* xy =
        i == 0 ? selection.mutable_boundary_xy_mm() : selection.add_more_boundary_rings()->mutable_xy_mm();
    if (const absl::Status read = ReadRing(options.boundary[i], "--boundary", xy); !read.ok()) return read;
  }
  if (!options.boundary.empty()) {
    selection.set_boundary_mode(MakeMode(options.boundary_mode));
    selection.set_boundary_offset_mm(options.boundary_offset);
  }
  return absl::OkStatus();
}

}  // namespace patchmill::cli
