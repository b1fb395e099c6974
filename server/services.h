// The services. Each method calls its handler.
#pragma once

#include <memory>
#include <vector>

#include <grpcpp/impl/service_type.h>

#include "server/call.h"

namespace patchmill {

struct NamedService {
  const char* name;  // in the health service
  std::unique_ptr<grpc::Service> service;
};

// `env` must outlive the services.
std::vector<NamedService> MakeServices(ServerEnv* env);

}  // namespace patchmill
