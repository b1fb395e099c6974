// The services, each method one call of its handler.
#pragma once

#include <memory>
#include <vector>

#include <grpcpp/impl/service_type.h>

#include "server/call.h"

namespace patchmill {

struct NamedService {
  const char* name;  // as health names it
  std::unique_ptr<grpc::Service> service;
};

// `env` outlives the services.
std::vector<NamedService> MakeServices(ServerEnv* env);

}  // namespace patchmill
