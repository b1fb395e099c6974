// Enums of the wire <-> enums of the domain. Unspecified becomes the documented default. A number that this
// version does not know is an error, never a silent default.
#pragma once

#include <string>

#include "cam/plan/job.h"
#include "patchmill/v1/diagnostic.pb.h"
#include "patchmill/v1/operation.pb.h"
#include "patchmill/v1/region.pb.h"
#include "patchmill/v1/report.pb.h"
#include "patchmill/v1/setup.pb.h"
#include "patchmill/v1/tool.pb.h"
#include "patchmill/v1/toolpath.pb.h"
#include "server/errors.h"

namespace patchmill {

UpAxis FromProto(v1::UpAxis value, const std::string& field, FieldErrors& errors);
Setup::Zero FromProto(v1::ZeroAnchor value, const std::string& field, FieldErrors& errors);
Coolant FromProto(v1::Coolant value, const std::string& field, FieldErrors& errors);
Strategy FromProto(v1::Strategy value, const std::string& field, FieldErrors& errors);
CutDirection FromProto(v1::CutDirection value, const std::string& field, FieldErrors& errors);
BoundaryMode FromProto(v1::BoundaryMode value, const std::string& field, FieldErrors& errors);
EdgeRule FromProto(v1::EdgeRule value, const std::string& field, FieldErrors& errors);

v1::UpAxis ToProto(UpAxis value);
v1::ZeroAnchor ToProto(Setup::Zero value);
v1::Coolant ToProto(Coolant value);
v1::Strategy ToProto(Strategy value);
v1::CutDirection ToProto(CutDirection value);
v1::BoundaryMode ToProto(BoundaryMode value);
v1::EdgeRule ToProto(EdgeRule value);
v1::MoveKind ToProto(MoveKind value);
v1::ArcPlane ToProto(ArcPlane value);
v1::BorderKind ToProto(BorderKind value);
v1::RegionKind ToProto(RegionKind value);
v1::Slope ToProto(SlopeClass value);
v1::UnreachableReason ToProto(UnreachableReason value);
v1::UnreachableReason ToProto(UncutReason value);
v1::Severity ToProto(Severity value);
v1::Outcome ToProto(Outcome value);

}  // namespace patchmill
