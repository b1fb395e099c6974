// grpc.reflection.v1alpha.ServerReflection: what the services look like, for clients without their protos.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "server/small_service.h"

namespace patchmill {

// Lists these services. Other arguments as MakeSmallService.
std::unique_ptr<SmallService> MakeReflectionService(std::vector<std::string> services, InFlight& in_flight,
                                                    CallRules rules);

}  // namespace patchmill
