// v1.Machine <-> Machine.
#pragma once

#include <string_view>

#include "cam/toolpath/machine.h"
#include "patchmill/v1/setup.pb.h"
#include "server/errors.h"

namespace patchmill {

// Findings name fields below `at`.
Machine FromProto(const v1::Machine& proto, std::string_view at, FieldErrors& errors);
v1::Machine ToProto(const Machine& machine);

}  // namespace patchmill
