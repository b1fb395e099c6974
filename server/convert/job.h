// v1.Job and v1.Post <-> Job.
#pragma once

#include <string_view>

#include "cam/plan/job.h"
#include "patchmill/v1/job.pb.h"
#include "server/errors.h"

namespace patchmill {

// Reads and validates everything but the model. Every wrong field is added to `errors`; the result may be
// used only if none was added. `at` is the path of the job in its request.
Job FromProto(const v1::Job& job, const v1::Post& post, std::string_view at, FieldErrors& errors);

// Read two fields of an operation. `at` is the path of the message that has them.
double ReadSteepAngle(double degrees, std::string_view at, FieldErrors& errors);  // rad
// The dialect of this name, or that of the post file if there is one. `at` ends with a dot or is empty.
Dialect ReadDialect(const std::string& name, const std::string& post_file, const std::string& at,
                    FieldErrors& errors);
double ReadControlDeviation(double deviation_mm, const std::string& at, FieldErrors& errors);  // mm
double ReadAcceptDepth(double depth_mm, std::string_view at, FieldErrors& errors);
double ReadDetail(double detail, std::string_view at, FieldErrors& errors);

// Reads one operation. `at` is the path of the operation.
Operation FromProto(const v1::Operation& proto, std::string_view at, FieldErrors& errors);

v1::Operation ToProto(const Job& job, const Operation& operation);
// The resolved job as the client receives it. The model is replaced by its digest.
v1::Job ToProto(const Job& job, std::string_view model_digest, std::string_view name);
v1::Post PostToProto(const Job& job);

}  // namespace patchmill
