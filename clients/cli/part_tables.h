// Tables of a part that `patchmill check` prints. Nothing is printed for a model without faces.
#pragma once

#include "patchmill/v1/model_service.pb.h"

namespace patchmill::cli {

// A line for each kind and radius of concave faces. `all`: every line and every face is named; else the
// smallest radii of each kind and the first few faces.
void PrintConcaveFaces(const v1::CheckModelResponse& response, bool all);
// A line for all holes of one diameter, depth, direction and form.
void PrintHoles(const v1::CheckModelResponse& response, bool all);
// A line for each axis of the model that could point up.
void PrintUpDirections(const v1::CheckModelResponse& response);

}  // namespace patchmill::cli
