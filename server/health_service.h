// grpc.health.v1.Health.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>

#include "server/small_service.h"

namespace patchmill {

class HealthService {
 public:
  // Arguments as MakeSmallService.
  HealthService(InFlight& in_flight, CallRules rules);
  grpc::Service* service() { return service_.get(); }
  // Of the service of that name, "" for the server as a whole. A name is unknown until it is set.
  void SetServing(const std::string& name, bool serving);

 private:
  absl::StatusOr<std::string> Check(const std::string& request);
  absl::StatusOr<std::string> Watch(const std::string& request);

  std::mutex mutex_;
  std::unordered_map<std::string, bool> serving_;
  std::unique_ptr<SmallService> service_;
};

}  // namespace patchmill
