#include "server/convert/model.h"

#include <set>

#include "core/base/status.h"
#include "core/joining/join_network.h"
#include "core/joining/network_findings.h"
#include "server/convert/faces.h"
#include "server/convert/fields.h"
#include "server/convert/model_limits.h"
#include "server/convert/network.h"
#include "server/convert/patches.h"
#include "server/limits.h"

namespace patchmill {

std::optional<double> MillimetersPer(v1::LengthUnit unit) {
  switch (unit) {
    case v1::LENGTH_UNIT_MILLIMETER:
      return 1.0;
    case v1::LENGTH_UNIT_INCH:
      return 25.4;
    case v1::LENGTH_UNIT_METER:
      return 1000.0;
    default:
      return std::nullopt;
  }
}

std::string UnitFault(v1::LengthUnit unit) {
  if (unit == v1::LENGTH_UNIT_UNSPECIFIED) {
    return "is missing; add \"length_unit\": \"LENGTH_UNIT_MILLIMETER\", or LENGTH_UNIT_INCH or "
           "LENGTH_UNIT_METER";
  }
  return fmt::format("= {}; must be LENGTH_UNIT_MILLIMETER, LENGTH_UNIT_INCH or LENGTH_UNIT_METER",
                     static_cast<int>(unit));
}

namespace {

// Fields that every model has: length unit in mm, and join tolerance.
struct ModelHead {
  double unit = 1.0;
  std::optional<double> join_tolerance;
};

absl::StatusOr<ModelHead> HeadOf(const v1::PatchModel& proto, std::string_view at) {
  PM_RETURN_IF_ERROR(CheckLimits(proto));
  FieldErrors errors;
  const std::optional<double> unit = MillimetersPer(proto.length_unit());
  if (!unit) {
    errors.Add(At(at, "length_unit"), UnitFault(proto.length_unit()));
  }
  if (proto.has_network() && !proto.patches().empty()) {
    errors.Add(At(at, "network"), "is set together with patches; set one of them");
  }
  if (proto.has_network() && !proto.faces().empty()) {
    errors.Add(At(at, "faces"), "are set together with a network; they belong to patches");
  }
  if (proto.patches().empty() && !proto.has_network()) errors.Missing(At(at, "patches"));
  ModelHead head;
  if (proto.has_join_tolerance_mm()) {
    const double tolerance = proto.join_tolerance_mm();
    Require(errors, At(at, "join_tolerance_mm"), tolerance,
            tolerance > 0.0 && tolerance <= limits::kMaxJoinToleranceMm,
            fmt::format("in (0, {}]", limits::kMaxJoinToleranceMm));
    head.join_tolerance = tolerance;
  }
  PM_RETURN_IF_ERROR(errors.ToStatus());
  head.unit = *unit;
  return head;
}

CheckedNetwork ReadNetwork(const v1::PatchModel& proto, const ModelHead& head) {
  CheckedNetwork checked;
  checked.unit = head.unit;
  checked.network = FromProto(proto.network(), head.unit, checked.faults);
  checked.network.join_tolerance = head.join_tolerance;
  return checked;
}

}  // namespace

absl::StatusOr<CheckedNetwork> NetworkFromProto(const v1::PatchModel& proto, std::string_view at) {
  PM_ASSIGN_OR_RETURN(const ModelHead head, HeadOf(proto, at));
  if (proto.has_network()) return ReadNetwork(proto, head);
  FieldErrors errors;
  errors.Add(At(at, "patches"), "make a model that has no network; must be a network");
  return errors.ToStatus();
}

absl::StatusOr<CheckedModel> FromProto(const v1::PatchModel& proto, std::string_view at,
                                       const RunContext& run) {
  PM_ASSIGN_OR_RETURN(const ModelHead head, HeadOf(proto, at));
  CheckedModel checked;
  checked.model.join_tolerance = head.join_tolerance;
  if (proto.has_network()) {
    CheckedNetwork read = ReadNetwork(proto, head);
    checked.faults = std::move(read.faults);
    if (!checked.faults.empty()) return checked;
    PM_ASSIGN_OR_RETURN(JoinedNetwork joined, JoinNetwork(read.network, run));
    checked.model = std::move(joined.model);
    (HasError(joined.findings) ? checked.faults : checked.remarks) = std::move(joined.findings);
    if (checked.faults.empty()) checked.faults = ValidateModel(checked.model);
    return checked;
  }
  checked.model.patches.reserve(static_cast<std::size_t>(proto.patches_size()));
  constexpr int kPolled = 1024;  // patches between two looks at the run
  for (int i = 0; i < proto.patches_size(); ++i) {
    if (i % kPolled == 0) PM_RETURN_IF_ERROR(run.Check());
    checked.model.patches.push_back(FromProto(proto.patches(i), head.unit, i, checked.faults));
  }
  checked.model.faces.reserve(static_cast<std::size_t>(proto.faces_size()));
  for (int f = 0; f < proto.faces_size(); ++f) {
    checked.model.faces.push_back(FromProto(proto.faces(f), f, checked.faults));
  }
  // A patch with a fault of the message is not reported twice.
  std::set<int> reported;
  for (const Diagnostic& fault : checked.faults) {
    if (fault.where.patch_index) reported.insert(*fault.where.patch_index);
  }
  PM_RETURN_IF_ERROR(run.Check());
  for (Diagnostic& fault : ValidateModel(checked.model)) {
    if (fault.where.patch_index && reported.contains(*fault.where.patch_index)) continue;
    checked.faults.push_back(std::move(fault));
  }
  return checked;
}

v1::PatchModel ToProto(const PatchModel& model) {
  v1::PatchModel proto;
  proto.set_length_unit(v1::LENGTH_UNIT_MILLIMETER);
  if (model.join_tolerance) proto.set_join_tolerance_mm(*model.join_tolerance);
  proto.mutable_patches()->Reserve(static_cast<int>(model.patches.size()));
  for (const Patch& patch : model.patches) *proto.add_patches() = ToProto(patch);
  for (const ModelFace& face : model.faces) *proto.add_faces() = ToProto(face);
  return proto;
}

}  // namespace patchmill
