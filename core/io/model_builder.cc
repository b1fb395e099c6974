#include "core/io/model_builder.h"

#include <utility>

#include <fmt/format.h>

#include "core/base/status.h"
#include "core/network/control_points.h"

namespace patchmill {

absl::StatusOr<std::vector<Vec3>> ReadPoints(TextScanner& scanner, int count) {
  std::vector<Vec3> points;
  points.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    PM_ASSIGN_OR_RETURN(const Vec3 p, scanner.Point());
    points.push_back(p);
  }
  return points;
}

absl::StatusOr<RationalPoints> ReadRationalPoints(TextScanner& scanner, int count) {
  RationalPoints net;
  for (int i = 0; i < count; ++i) {
    PM_ASSIGN_OR_RETURN(const Vec3 product, scanner.Point());
    PM_ASSIGN_OR_RETURN(const double weight, scanner.Number("weight of a point"));
    if (!(weight >= kMinWeight && weight <= kMaxWeight)) {
      const std::string reason =
          fmt::format("weight of a point = {:g}; must be in [{:g}, {:g}]", weight, kMinWeight, kMaxWeight);
      return weight == 0.0 ? scanner.Fail("ZERO_WEIGHT", reason) : scanner.Fail(reason);
    }
    net.points.push_back(product / weight);
    net.weights.push_back(weight);
    if (!(net.points.back().cwiseAbs().maxCoeff() <= kMaxCoordinate)) {
      return scanner.Fail(
          fmt::format("the point divided by its weight {:g} lies beyond {:g}", weight, kMaxCoordinate));
    }
  }
  return net;
}

absl::StatusOr<int> ReadDegree(TextScanner& scanner, std::string_view what) {
  return scanner.Integer(what, 1, kMaxDegree);
}

absl::StatusOr<int> ReadPatchCount(TextScanner& scanner, std::size_t bytes_per_patch) {
  PM_ASSIGN_OR_RETURN(const int count, scanner.Integer("number of patches", 1, kMaxPatches));
  const std::size_t room = scanner.remaining() / bytes_per_patch;
  if (static_cast<std::size_t>(count) > room) {
    return scanner.Fail(
        fmt::format("{} patches are announced; the text has room for {} at most", count, room));
  }
  return count;
}

absl::Status ModelBuilder::Add(const TextScanner& scanner, int line, PatchShape shape) {
  if (model_.patches.size() >= static_cast<std::size_t>(kMaxPatches)) {
    return scanner.Fail(fmt::format("more than {} patches", kMaxPatches));
  }
  points_ += ControlPoints(shape).size();
  if (points_ > static_cast<std::size_t>(kMaxControlPoints)) {
    return scanner.Fail(fmt::format("more than {} control points", kMaxControlPoints));
  }
  model_.patches.push_back({"", std::move(shape)});
  lines_.push_back(line);
  return absl::OkStatus();
}

absl::StatusOr<PatchModel> ModelBuilder::Finish(TextScanner& scanner) {
  PM_RETURN_IF_ERROR(scanner.ExpectEnd());
  const Diagnostics faults = ValidateModel(model_);
  if (faults.empty()) return std::move(model_);
  const Diagnostic& first = faults.front();
  const int line = first.where.patch_index ? lines_[static_cast<std::size_t>(*first.where.patch_index)] : 1;
  return absl::InvalidArgumentError(fmt::format("line {}: {}", line, first.message));
}

}  // namespace patchmill
