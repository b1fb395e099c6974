// Services of small messages that are answered at once, without a thread of the call: health and
// reflection. Their requests are counted as those of raw_service.h; gRPC's own handlers read them first.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <absl/status/statusor.h>
#include <grpcpp/impl/service_type.h>

#include "server/in_flight.h"
#include "server/raw_service.h"

namespace patchmill {

struct SmallMethod {
  // What a call does after it has sent an answer: it ends, it reads the next request, or it answers the same
  // request again after each Changed(), where the answer is another one.
  enum class Then { kEnd, kRead, kWatch };
  std::string path;  // "/grpc.health.v1.Health/Check"
  Then then = Then::kEnd;
  // Called from any thread, several at once. It blocks for no longer than a lock.
  std::function<absl::StatusOr<std::string>(const std::string& request)> answer;
};

class SmallService : public grpc::Service {
 public:
  virtual void Changed() = 0;
};

// A request beyond limits::kMaxSmallMessageBytes is LIMIT_EXCEEDED. Requests and answers are counted in
// `in_flight`, which outlives the service. `rules` has no log.
std::unique_ptr<SmallService> MakeSmallService(std::vector<SmallMethod> methods, InFlight& in_flight,
                                               CallRules rules);

}  // namespace patchmill
