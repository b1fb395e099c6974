// v1.Job and v1.Post <-> Job.
#pragma once

#include <string_view>

#include "cam/plan/job.h"
#include "patchmill/v1/job.pb.h"
#include "server/errors.h"

namespace patchmill {

// Everything but the model, fully validated: every wrong field is added to `errors`; the result may be used
// when none was. `at` is the path of the job in its request.
Job FromProto(const v1::Job& job, const v1::Post& post, std::string_view at, FieldErrors& errors);

// Two of its fields; `at` is the path of the message that has them.
double ReadSteepAngle(double degrees, std::string_view at, FieldErrors& errors);  // rad
double ReadDetail(double detail, std::string_view at, FieldErrors& errors);

// One operation; `at` is its own path.
Operation FromProto(const v1::Operation& proto, std::string_view at, FieldErrors& errors);

v1::Operation ToProto(const Job& job, const Operation& operation);
// The resolved job as the client gets it back, the model replaced by its digest.
v1::Job ToProto(const Job& job, std::string_view model_digest, std::string_view name);
v1::Post PostToProto(const Job& job);

}  // namespace patchmill
