#include "core/editing/guide_curve.h"

#include <algorithm>
#include <cmath>

#include "core/curve/spline.h"

namespace patchmill {
namespace {

// The chords serve as spans where the surface's ratios would make one this many times longer or shorter.
constexpr double kMostStretch = 4.0;

std::vector<double> SpansOf(const std::vector<GuideSpan>& faces, const std::vector<HermiteCurve>& chords) {
  std::vector<double> spans = {1.0}, chord;
  for (std::size_t k = 1; k < faces.size(); ++k) {
    spans.push_back(spans.back() * faces[k].from.norm() / faces[k - 1].to.norm());
  }
  double sum = 0.0, chord_sum = 0.0;
  for (std::size_t k = 0; k < faces.size(); ++k) {
    chord.push_back((chords[k].p1 - chords[k].p0).norm());
    sum += spans[k], chord_sum += chord[k];
  }
  for (std::size_t k = 0; k < faces.size(); ++k) {
    const double stretch = spans[k] / sum / (chord[k] / chord_sum);
    if (!(stretch < kMostStretch && stretch > 1.0 / kMostStretch)) return chord;
  }
  return spans;
}

// The part that a cubic spline's second derivative lacks at the point between two spans, per square of the
// parameter of the first one [joining (36)].
Vec3 MissingBend(const HermiteCurve& before, const HermiteCurve& after, double ratio) {
  const auto third = [](const HermiteCurve& c) { return Vec3(12.0 * (c.p0 - c.p1) + 6.0 * (c.d0 + c.d1)); };
  const Vec3 jump = third(after) / (ratio * ratio * ratio) - third(before);
  return (1.0 - ratio + ratio * ratio) / (6.0 * (1.0 + ratio)) * jump;
}

}  // namespace

absl::StatusOr<std::vector<GuideSection>> GuideThrough(const std::vector<Vec3>& middles,
                                                       const std::vector<GuideSpan>& faces,
                                                       const GuideDirections& directions) {
  const bool closed = faces.size() == middles.size();
  // Checks the points, too.
  const auto chords = SplineThrough(middles, closed);
  if (!chords.ok()) return chords.status();
  const std::vector<double> spans = SpansOf(faces, *chords);
  SplineEnds ends{Vec3(faces.front().from / spans.front()), Vec3(-faces.back().to / spans.back())};
  if (directions.start) ends.start = ends.start->norm() * directions.start->normalized();
  if (directions.end) ends.end = ends.end->norm() * directions.end->normalized();
  const std::vector<HermiteCurve> spline = SplineOver(middles, spans, ends);
  std::vector<GuideSection> sections;
  for (const HermiteCurve& span : spline) {
    const CurveJet from = Evaluate(span, 0.0), to = Evaluate(span, 1.0);
    sections.push_back({{from.d, from.dd}, {-to.d, to.dd}});
  }
  for (std::size_t k = closed ? 0 : 1; k < spline.size(); ++k) {
    const std::size_t before = (k + spline.size() - 1) % spline.size();
    const double ratio = spans[k] / spans[before];
    const Vec3 missing = MissingBend(spline[before], spline[k], ratio);
    sections[before].to.dd += missing;
    sections[k].from.dd += ratio * ratio * missing;
  }
  return sections;
}

}  // namespace patchmill
