#include "server/health_service.h"

#include <utility>

#include <google/protobuf/wrappers.pb.h>

#include "core/base/status.h"
#include "server/errors.h"

namespace patchmill {
namespace {

// Of HealthCheckResponse.ServingStatus.
constexpr int kServing = 1, kNotServing = 2, kServiceUnknown = 3;

// grpc.health.v1 is not packaged as a library. On the wire its request is a StringValue (1: the service), its
// answer an Int32Value (1: the status).
absl::StatusOr<std::string> ServiceOf(const std::string& request) {
  google::protobuf::StringValue message;
  if (!message.ParseFromString(request))
    return RequestUnreadableError("the request is no HealthCheckRequest");
  return message.value();
}

std::string HealthAnswer(int status) {
  google::protobuf::Int32Value message;
  message.set_value(status);
  return message.SerializeAsString();
}

}  // namespace

HealthService::HealthService(InFlight& in_flight, CallRules rules) {
  std::vector<SmallMethod> methods;
  methods.push_back({"/grpc.health.v1.Health/Check", SmallMethod::Then::kEnd,
                     [this](const std::string& request) { return Check(request); }});
  methods.push_back({"/grpc.health.v1.Health/Watch", SmallMethod::Then::kWatch,
                     [this](const std::string& request) { return Watch(request); }});
  service_ = MakeSmallService(std::move(methods), in_flight, std::move(rules));
}

void HealthService::SetServing(const std::string& name, bool serving) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    serving_[name] = serving;
  }
  service_->Changed();
}

absl::StatusOr<std::string> HealthService::Check(const std::string& request) {
  PM_ASSIGN_OR_RETURN(const std::string name, ServiceOf(request));
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto at = serving_.find(name);
  if (at == serving_.end()) return absl::NotFoundError("the server has no service of that name");
  return HealthAnswer(at->second ? kServing : kNotServing);
}

absl::StatusOr<std::string> HealthService::Watch(const std::string& request) {
  PM_ASSIGN_OR_RETURN(const std::string name, ServiceOf(request));
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto at = serving_.find(name);
  if (at == serving_.end()) return HealthAnswer(kServiceUnknown);
  return HealthAnswer(at->second ? kServing : kNotServing);
}

}  // namespace patchmill
