// What the domain found -> the wire. Placed points become program-frame points: minus program zero.
#pragma once

#include <functional>
#include <string_view>

#include "cam/plan/job.h"
#include "cam/plan/resolve.h"
#include "patchmill/v1/diagnostic.pb.h"
#include "patchmill/v1/region.pb.h"
#include "patchmill/v1/report.pb.h"
#include "patchmill/v1/toolpath.pb.h"

namespace patchmill {

v1::Diagnostic ToProto(const Diagnostic& diagnostic, const Vec3& zero);

// At most limits::kMaxDiagnostics; then one says how many more there are.
void AddDiagnostics(const Diagnostics& from, const Vec3& zero,
                    google::protobuf::RepeatedPtrField<v1::Diagnostic>* to);

v1::Box ToProto(const Box3& box, const Vec3& zero);

enum class Detail { kAll, kFigures };  // figures: without borders and patches
v1::Region ToProto(const Region& region, const RegionChoice& choice, const Vec3& zero, Detail detail);

// The client's own id of each patch, in the order of the model; none when none has one.
google::protobuf::RepeatedPtrField<std::string> PatchIds(const PatchModel& model);

// `choices`: one for each region.
v1::RegionMap ToProto(const RegionMap& map, const std::vector<RegionChoice>& choices, const Vec3& zero);

v1::SetupSheet ToProto(const Resolved& resolved, const Job& job);

// What the verifier measured. `scallop_judged` is false when no scallop was asked for.
void FillFromVerifier(const VerifyReport& verify, const Vec3& zero, bool scallop_judged, v1::Report* report);

// The report of a job; `program` is what is sent, empty when nothing is.
v1::Report ToProto(const JobReport& report, const Job& job, const Resolved& resolved,
                   std::string_view program);

// The motion in chunks of at most limits::kPathChunkPoints, in order; stops early when `emit` says false.
bool EmitPaths(const Toolpath& toolpath, const Vec3& zero, const std::function<bool(v1::PathChunk)>& emit);

}  // namespace patchmill
