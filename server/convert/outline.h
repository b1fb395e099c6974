// Packed x y <-> rings, and v1.Selection <-> Selection.
#pragma once

#include <string>
#include <string_view>

#include <google/protobuf/repeated_field.h>

#include "cam/plan/job.h"
#include "patchmill/v1/operation.pb.h"
#include "server/errors.h"

namespace patchmill {

// Reads a sound ring (core/math/outline.h), or adds an error at `field`. `points` counts the points of all
// rings read so far; more than limits::kMaxOutlinePoints are an error.
Ring ReadRing(const google::protobuf::RepeatedField<double>& xy, const std::string& field,
              std::size_t& points, FieldErrors& errors);
void WriteRing(const Ring& ring, google::protobuf::RepeatedField<double>* xy);

// Reads a selection. Resolve checks later, with the model, whether the patches exist.
Selection FromProto(const v1::Selection& proto, std::string_view at, FieldErrors& errors);
v1::Selection ToProto(const Selection& selection);

}  // namespace patchmill
