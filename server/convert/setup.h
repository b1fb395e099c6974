// v1.Setup <-> Setup, v1.Tool <-> Tool.
#pragma once

#include <string>
#include <string_view>

#include "cam/plan/job.h"
#include "patchmill/v1/setup.pb.h"
#include "patchmill/v1/tool.pb.h"
#include "server/errors.h"

namespace patchmill {

Vec3 FromProto(const v1::Point3& proto);
// Reads a point and checks its coordinates. `at` is the path of the point.
Vec3 ReadPoint(const v1::Point3& proto, const std::string& at, FieldErrors& errors);
v1::Point3 ToProto(const Vec3& p);

// Every wrong field is added to `errors` with its path below `at`. The result may be used only if none was
// added.
Setup FromProto(const v1::Setup& proto, std::string_view at, FieldErrors& errors);

enum class CuttingData { kRequired, kOptional };
Tool FromProto(const v1::Tool& proto, std::string_view at, CuttingData cutting_data, FieldErrors& errors);

v1::Setup ToProto(const Setup& setup);
v1::Tool ToProto(const Tool& tool);

}  // namespace patchmill
