#include "server/convert/fairing.h"

#include <cmath>

#include <fmt/format.h>

#include "core/base/status.h"
#include "core/io/curve_points.h"
#include "server/convert/fields.h"
#include "server/limits.h"

namespace patchmill {
namespace {

using Numbers = google::protobuf::RepeatedField<double>;

static_assert(limits::kMaxCurvePoints == kMaxFairingPoints && kMaxFairingPoints == kMaxCurvePoints,
              "a curve that may be sent can be read, and faired");

absl::StatusOr<std::vector<Vec3>> PointsOf(const Numbers& xyz) {
  const auto count = static_cast<std::size_t>(xyz.size());
  if (count / 3 > limits::kMaxCurvePoints) {
    return LimitError("points", static_cast<double>(limits::kMaxCurvePoints), static_cast<double>(count / 3));
  }
  FieldErrors errors;
  if (count % 3 != 0) {
    errors.Add("points.points_mm", fmt::format("has {} numbers; must have three for each point", count));
  }
  constexpr double kMost = limits::kMaxCurveCoordinate;
  std::vector<Vec3> points;
  for (int i = 0; i + 2 < xyz.size(); i += 3) {
    const Vec3 p(xyz[i], xyz[i + 1], xyz[i + 2]);
    for (int k = 0; k < 3; ++k) {
      Require(errors, fmt::format("points.points_mm[{}]", i + k), p[k], std::abs(p[k]) <= kMost,
              fmt::format("in [{:g}, {:g}]", -kMost, kMost));
    }
    points.push_back(p);
  }
  PM_RETURN_IF_ERROR(errors.ToStatus());
  return points;
}

Axes FromProto(const google::protobuf::RepeatedField<int>& proto, const std::string& field,
               FieldErrors& errors) {
  if (proto.empty()) return {true, true, true};
  Axes axes{false, false, false};
  for (const int axis : proto) {
    if (axis < v1::AXIS_X || axis > v1::AXIS_Z) {
      errors.Add(field, fmt::format("= {}; must be 1 (x), 2 (y) or 3 (z)", axis));
    } else {
      axes[static_cast<std::size_t>(axis - v1::AXIS_X)] = true;
    }
  }
  return axes;
}

std::optional<Vec3> Direction(const Numbers& proto, const char* field, FieldErrors& errors) {
  if (proto.empty()) return std::nullopt;
  if (proto.size() != 3) {
    errors.Add(field, fmt::format("has {} numbers; must have three", proto.size()));
    return std::nullopt;
  }
  const Vec3 direction(proto[0], proto[1], proto[2]);
  constexpr double kMost = limits::kMaxCurveCoordinate;
  const double size = direction.cwiseAbs().maxCoeff();
  Require(errors, field, size, direction.allFinite() && size >= 1.0 / kMost && size <= kMost,
          fmt::format("of a length in [{:g}, {:g}]", 1.0 / kMost, kMost));
  return direction;
}

Vec3 Band(const v1::FairingBand& proto, double diagonal, FieldErrors& errors) {
  const auto check = [&](bool has, double value, const char* field) {
    if (has) Require(errors, At("band", field), value, value >= 0.0, ">= 0");
  };
  check(proto.has_x_mm(), proto.x_mm(), "x_mm");
  check(proto.has_y_mm(), proto.y_mm(), "y_mm");
  check(proto.has_z_mm(), proto.z_mm(), "z_mm");
  check(proto.has_fraction(), proto.fraction(), "fraction");
  const double rest = proto.has_fraction() ? proto.fraction() * diagonal : kInfinity;
  return {proto.has_x_mm() ? proto.x_mm() : rest, proto.has_y_mm() ? proto.y_mm() : rest,
          proto.has_z_mm() ? proto.z_mm() : rest};
}

FairingStop FromProto(v1::FairingStop value, FieldErrors& errors) {
  switch (value) {
    case v1::FAIRING_STOP_UNSPECIFIED:
    case v1::FAIRING_STOP_SIGNS:
      return FairingStop::kSigns;
    case v1::FAIRING_STOP_SIGNS_AND_ENERGY:
      return FairingStop::kSignsAndEnergy;
    case v1::FAIRING_STOP_ITERATIONS:
      return FairingStop::kIterations;
    default:
      errors.Add("stop", fmt::format("= {}; this server does not know that value", static_cast<int>(value)));
      return FairingStop::kSigns;
  }
}

BandRule FromProto(v1::BandRule value, FieldErrors& errors) {
  switch (value) {
    case v1::BAND_RULE_UNSPECIFIED:
    case v1::BAND_RULE_LEAST_ENERGY:
      return BandRule::kLeastEnergy;
    case v1::BAND_RULE_CUT:
      return BandRule::kCut;
    default:
      errors.Add("band_rule",
                 fmt::format("= {}; this server does not know that value", static_cast<int>(value)));
      return BandRule::kLeastEnergy;
  }
}

// The points of a request, which come as numbers or in a file.
template <class Request>
absl::StatusOr<CurvePoints> ReadPoints(const Request& request, const char* field) {
  if (request.has_points()) {
    CurvePoints points;
    PM_ASSIGN_OR_RETURN(points.points, PointsOf(request.points().points_mm()));
    return points;
  }
  if (request.has_file()) {
    absl::StatusOr<CurvePoints> read = ReadCurvePoints(request.file().format(), request.file().content());
    if (!read.ok()) return CurveUnreadableError(std::string(read.status().message()));
    return read;
  }
  FieldErrors errors;
  errors.Missing(field);
  return errors.ToStatus();
}

// The terms that requests for curves and nets share.
template <class Request>
FairingTerms ReadTerms(const Request& request, const std::vector<Vec3>& points, FieldErrors& errors) {
  FairingTerms terms;
  const int count = static_cast<int>(points.size());
  terms.axes = FromProto(request.axes(), "axes", errors);
  terms.band = Band(request.band(), Diagonal(points), errors);
  for (int k = 0; k < request.locks_size(); ++k) {
    const std::string at = fmt::format("locks[{}]", k);
    const v1::PointLock& lock = request.locks(k);
    Require(errors, At(at, "point_index"), lock.point_index(),
            lock.point_index() >= 0 && lock.point_index() < count, fmt::format("in [0, {}]", count - 1));
    terms.locks.push_back({lock.point_index(), FromProto(lock.axes(), At(at, "axes"), errors)});
  }
  if (request.has_max_iterations()) {
    terms.max_iterations = request.max_iterations();
    Require(errors, "max_iterations", terms.max_iterations,
            terms.max_iterations >= 0 && terms.max_iterations <= kMaxFairingIterations,
            fmt::format("in [0, {}]", kMaxFairingIterations));
  }
  terms.stop = FromProto(request.stop(), errors);
  terms.band_rule = FromProto(request.band_rule(), errors);
  return terms;
}

absl::Status CheckLocks(int count) {
  if (static_cast<std::size_t>(count) <= limits::kMaxCurvePoints) return absl::OkStatus();
  return LimitError("locks", static_cast<double>(limits::kMaxCurvePoints), count);
}

void Add(const Vec3& p, Numbers* to) {
  for (const double x : p) to->Add(x);
}

// The curve of a beam as a cubic B-spline. Each inner knot counts three times, so that the points of the beam
// are among the control points, to the bit.
void FillCurve(const Beam& beam, v1::BsplineCurve* to) {
  to->set_degree(3);
  double knot = 0.0;
  for (int k = 0; k < 4; ++k) to->add_knots(0.0);
  Add(beam.points.front(), to->mutable_points());
  for (std::size_t i = 0; i < beam.chords.size(); ++i) {
    const double chord = beam.chords[i];
    knot += chord;
    Add(beam.points[i] + chord / 3.0 * beam.tangents[i], to->mutable_points());
    Add(beam.points[i + 1] - chord / 3.0 * beam.tangents[i + 1], to->mutable_points());
    Add(beam.points[i + 1], to->mutable_points());
    const bool last = i + 1 == beam.chords.size();
    for (int k = 0; k < (last ? 4 : 3); ++k) to->add_knots(knot);
  }
}

}  // namespace

absl::StatusOr<FairingOrder> FromProto(const v1::FairCurveRequest& request) {
  PM_RETURN_IF_ERROR(CheckLocks(request.locks_size()));
  PM_ASSIGN_OR_RETURN(CurvePoints read, ReadPoints(request, "curve"));
  FairingOrder order;
  order.curve.points = std::move(read.points);
  order.title = std::move(read.title);
  order.planar = read.planar;
  FieldErrors errors;
  const int count = static_cast<int>(order.curve.points.size());
  Require(errors, "points", count, count >= 2, "at least 2");
  order.curve.terms = ReadTerms(request, order.curve.points, errors);
  order.curve.start_direction = Direction(request.start_direction(), "start_direction", errors);
  order.curve.end_direction = Direction(request.end_direction(), "end_direction", errors);
  if (request.has_polyline_tolerance_mm()) {
    order.polyline_tolerance = request.polyline_tolerance_mm();
    Require(errors, "polyline_tolerance_mm", *order.polyline_tolerance, *order.polyline_tolerance > 0.0,
            "> 0");
  }
  RequireBytes(errors, "name", request.name(), limits::kMaxNameBytes);
  PM_RETURN_IF_ERROR(errors.ToStatus());
  return order;
}

absl::StatusOr<NetFairingOrder> FromProto(const v1::FairNetRequest& request) {
  PM_RETURN_IF_ERROR(CheckLocks(request.locks_size()));
  PM_ASSIGN_OR_RETURN(CurvePoints read, ReadPoints(request, "net"));
  NetFairingOrder order;
  order.net.points = std::move(read.points);
  order.title = std::move(read.title);
  order.planar = read.planar;
  FieldErrors errors;
  const int count = static_cast<int>(order.net.points.size()), lines = request.line_count();
  if (lines < 2 || count % lines != 0 || count / lines < 2) {
    errors.Add("line_count",
               fmt::format("= {} of {} points; must be 2 or more lines of equally many points, 2 or more",
                           lines, count));
  } else {
    order.net.count_u = lines;
    order.net.count_v = count / lines;
  }
  order.net.terms = ReadTerms(request, order.net.points, errors);
  PM_RETURN_IF_ERROR(errors.ToStatus());
  return order;
}

void Fill(const NetFairingOrder& order, const FairedNet& faired, v1::FairNetResponse* response) {
  double farthest = 0.0;
  for (std::size_t i = 0; i < faired.after.points.size(); ++i) {
    Add(faired.after.points[i], response->mutable_points_mm());
    if (faired.moved[i].norm() > farthest) {
      farthest = faired.moved[i].norm();
      response->set_max_moved_point_index(static_cast<int>(i));
    }
  }
  response->set_max_moved_mm(farthest);
  response->set_iteration_count(static_cast<int>(faired.energies.size()) - 1);
  response->set_settled(faired.settled);
  response->mutable_energies()->Add(faired.energies.begin(), faired.energies.end());
  response->set_planar(order.planar);
  response->set_title(order.title);
}

absl::Status Fill(const FairingOrder& order, const FairedCurve& faired, v1::FairCurveResponse* response) {
  if (order.polyline_tolerance) {
    const double size = PolylineSize(faired.after, *order.polyline_tolerance);
    if (!(size <= limits::kMaxPolylinePoints)) {
      return LimitError("polyline points", limits::kMaxPolylinePoints, size);
    }
    for (const Vec3& p : Polyline(faired.after, *order.polyline_tolerance)) {
      Add(p, response->mutable_polyline_mm());
    }
  }
  const std::vector<Vec3> before = ProjectedCurvatures(faired.before),
                          after = ProjectedCurvatures(faired.after);
  double farthest = 0.0;
  for (std::size_t i = 0; i < faired.node.size(); ++i) {
    const auto node = static_cast<std::size_t>(faired.node[i]);
    Add(faired.after.points[node], response->mutable_points_mm());
    Add(before[node], response->mutable_curvatures_before());
    Add(after[node], response->mutable_curvatures_after());
    if (faired.moved[i].norm() > farthest) {
      farthest = faired.moved[i].norm();
      response->set_max_moved_point_index(static_cast<int>(i));
    }
  }
  response->set_max_moved_mm(farthest);
  response->set_iteration_count(faired.iterations());
  response->set_settled(faired.settled);
  response->mutable_energies()->Add(faired.energies.begin(), faired.energies.end());
  response->set_planar(order.planar);
  response->set_title(order.title);
  FillCurve(faired.after, response->mutable_curve());
  return absl::OkStatus();
}

}  // namespace patchmill
