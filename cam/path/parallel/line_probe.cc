#include "cam/path/parallel/line_probe.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "cam/location/simd/heights.h"
#include "cam/path/chord/chord_thinning.h"
#include "cam/path/stepover/step_over.h"
#include "core/diffgeo/forms.h"

namespace patchmill {

LineProber::LineProber(const Locator& locator, const SheetBorder& border, const LineFrame& frame,
                       const LineProbeParams& params, const RunContext& run)
    : locator_(locator),
      border_(border),
      frame_(frame),
      params_(params.pass),
      part_(params.part),
      where_(params.where),
      run_(run),
      flat_step_(CenterStep(locator.radius(), params.pass.scallop, 0.0)) {}

LineProbe LineProber::Probe(double t, double y, double slope, const SurfacePoint* hint) const {
  return Judge(t, y, slope, locator_.Height(frame_.At(t, y), hint, CertificateGap(params_)));
}

std::vector<LineProbe> LineProber::ProbeRow(double t0, double t1, int count, const LineShape& line) const {
  std::vector<double> at;
  std::vector<Vec2> places;
  for (int i = 0; i <= count; ++i) {
    at.push_back(i == count ? t1 : t0 + (t1 - t0) * i / count);
    places.push_back(frame_.At(at.back(), line.At(at.back())));
  }
  std::vector<std::optional<CenterPoint>> heights(places.size());
  // Places.
  constexpr std::size_t kBetweenPolls = 1024;
  for (std::size_t i = 0; i < places.size() && !Cancelled(); i += kBetweenPolls) {
    const std::size_t n = std::min(kBetweenPolls, places.size() - i);
    Heights(locator_, std::span(places).subspan(i, n), std::span(heights).subspan(i, n),
            CertificateGap(params_));
  }
  std::vector<LineProbe> row;
  row.reserve(places.size());
  for (std::size_t i = 0; i < places.size(); ++i)
    row.push_back(Judge(at[i], line.At(at[i]), line.SlopeAt(at[i]), heights[i]));
  return row;
}

LineProbe LineProber::Judge(double t, double y, double slope, const std::optional<CenterPoint>& h) const {
  LineProbe probe;
  probe.t = t;
  if (!h) return probe;
  const Vec2 q = frame_.At(t, y);
  const double radius = locator_.radius();
  const double floor_center = params_.floor_z + radius;
  probe.half_step = 0.5 * flat_step_;
  probe.lateral = probe.half_step;
  if (h->z < floor_center) {
    probe.center = Lift(q, floor_center);
    probe.allowed = true;
    return probe;
  }
  probe.center = Lift(q, h->z);
  probe.contact = h->contact;
  const Vec3 normal = (probe.center - h->contact.p) / radius;
  probe.allowed = border_.Allowed(h->contact, normal);
  const double steepness = std::atan2(Xy(normal).norm(), normal.z());
  constexpr double kSlack = 1e-9;  // rad: a plane at the limit itself belongs to it
  probe.wanted = probe.allowed && steepness >= params_.window.min - kSlack &&
                 steepness <= params_.window.max + kSlack && (part_ == nullptr || part_->Wants(h->contact)) &&
                 (where_ == nullptr || where_->Has(h->contact.piece, h->contact.u, h->contact.v));

  // Across the feed on the centre surface is the direction square to the feed in the common tangent plane.
  // Its share in plan across the line is sqrt(1 - n_y^2); in y it is longer where the line slants.
  const double rise = slope / frame_.Stretch(y), slant = std::hypot(1.0, rise);
  const Vec2 feed = (frame_.Along(t) + rise * frame_.Across(t)) / slant;
  const Vec2 beside(-feed.y(), feed.x());
  const double nt = Xy(normal).dot(feed), ny = Xy(normal).dot(beside);
  const double cosine = std::sqrt(std::max(0.0, 1.0 - ny * ny));
  const SurfaceJet jet = Evaluate(locator_.surface(), h->contact.piece, h->contact.u, h->contact.v);
  const auto surface_normal = UpwardNormal(jet);
  const bool on_face = surface_normal && surface_normal->cross(normal).norm() < 1e-4;
  probe.finishes = probe.wanted && (on_face || border_.On(h->contact));
  if (on_face) {
    const double in_plane = std::hypot(nt, normal.z());
    const Vec3 across =
        in_plane > 1e-9
            ? Vec3(Lift((-nt * ny / in_plane) * feed + in_plane * beside, -ny * normal.z() / in_plane))
            : Vec3(Vec3::UnitZ());
    const double kappa = NormalCurvature(Forms(jet, *surface_normal), jet, across);
    const double step = std::clamp(CenterStep(radius, params_.scallop, kappa), min_step(), 4.0 * flat_step_);
    probe.need = step * cosine * slant;
    probe.half_step = 0.5 * step;
  }
  probe.lateral = probe.half_step * cosine * slant;
  return probe;
}

}  // namespace patchmill
