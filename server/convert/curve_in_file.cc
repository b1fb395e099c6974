#include "server/convert/curve_in_file.h"

#include <fmt/format.h>

#include "core/crossing/drawn_curve.h"
#include "core/io/curve_points.h"
#include "patchmill/v1/fairing.pb.h"
#include "proto/json/json_message.h"

namespace patchmill {
namespace {

absl::Status CurveFault(const std::string& text) { return absl::InvalidArgumentError(text); }

}  // namespace

BsplineCurve AsBspline(const BezierChain& chain) { return {chain.degree, ChainKnots(chain), chain.points}; }

absl::StatusOr<BezierChain> CurveIn(const v1::CurveInFile& file, double unit) {
  if (file.content().empty()) {
    return CurveFault("has no content; send the bytes of the file");
  }
  if (file.format() == "json") {
    v1::FairCurveResponse faired;
    const absl::Status status = ReadJsonMessage(file.content(), faired);
    if (!status.ok()) {
      return CurveFault(fmt::format("is no faired curve in JSON: {}", std::string(status.message())));
    }
    const v1::BsplineCurve& from = faired.curve();
    if (from.points_size() == 0) {
      return CurveFault("holds no curve; `patchmill fair POINTS -o FILE.json` writes one");
    }
    BsplineCurve curve{from.degree(), {from.knots().begin(), from.knots().end()}, {}};
    if (from.points_size() % 3 != 0) return CurveFault("has a curve whose points are not packed x y z");
    for (int i = 0; i + 2 < from.points_size(); i += 3) {
      curve.points.push_back(unit * Vec3(from.points(i), from.points(i + 1), from.points(i + 2)));
      if (!curve.points.back().allFinite()) return CurveFault("has a number that is not finite");
    }
    absl::StatusOr<BezierChain> chain = ChainOf(Curve(std::move(curve)));
    if (!chain.ok()) return CurveFault(fmt::format("is none: {}", std::string(chain.status().message())));
    return chain;
  }
  if (file.format() != "csv" && file.format() != "dat") {
    return CurveFault("has an unknown format; known are \"json\", \"csv\" and \"dat\"");
  }
  const absl::StatusOr<CurvePoints> read = ReadCurvePoints(file.format(), file.content());
  if (!read.ok()) return CurveFault(fmt::format("cannot be read: {}", std::string(read.status().message())));
  std::vector<Vec3> points = read->points;
  for (Vec3& p : points) p *= unit;
  absl::StatusOr<BezierChain> chain = ChainThrough(points);
  if (!chain.ok()) return CurveFault(std::string(chain.status().message()));
  return chain;
}

}  // namespace patchmill
