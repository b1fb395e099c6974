// Results of the domain -> messages. Points of the placed frame become points of the program frame: program
// zero is subtracted.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "cam/plan/job.h"
#include "cam/plan/resolve.h"
#include "patchmill/v1/diagnostic.pb.h"
#include "patchmill/v1/region.pb.h"
#include "patchmill/v1/report.pb.h"

namespace patchmill {

v1::Diagnostic ToProto(const Diagnostic& diagnostic, const Vec3& zero);

// Adds at most limits::kMaxDiagnostics findings. One more states how many are not listed.
void AddDiagnostics(const Diagnostics& from, const Vec3& zero,
                    google::protobuf::RepeatedPtrField<v1::Diagnostic>* to);

v1::Box ToProto(const Box3& box, const Vec3& zero);

enum class Detail { kAll, kFigures };  // kFigures leaves out borders and patches
v1::Region ToProto(const Region& region, const RegionChoice& choice, const RegionFigures& figures,
                   const Vec3& zero, Detail detail);

// The client's own id of each patch, in the order of the model. Empty if no patch has an id.
google::protobuf::RepeatedPtrField<std::string> PatchIds(const PatchModel& model);

// The id of each patch's face, in the order of the model; empty for a patch of no face. Empty if the model
// has no faces.
std::vector<std::string> FaceIds(const PatchModel& model);

// `choices` and `figures` have one element for each region; `face_ids` is as FaceIds gives it.
v1::RegionMap ToProto(const RegionMap& map, const std::vector<RegionChoice>& choices,
                      const std::vector<RegionFigures>& figures, const Vec3& zero,
                      const std::vector<std::string>& face_ids);

v1::SetupSheet ToProto(const Resolved& resolved, const Job& job);

// Fills the figures of the verifier. `scallop_judged` is false if no scallop was given.
void FillFromVerifier(const VerifyReport& verify, const Vec3& zero, bool scallop_judged, v1::Report* report);

// The report of a job. `program` is the text that is sent; empty if there is none.
v1::Report ToProto(const JobReport& report, const Job& job, const Resolved& resolved,
                   std::string_view program);

}  // namespace patchmill
