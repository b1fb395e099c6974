// Services whose requests come as bytes. The bytes are counted while they are on their way and before they
// are parsed. gRPC's own handlers parse a request before they call anything.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <absl/status/status.h>
#include <absl/status/statusor.h>
#include <google/protobuf/message.h>
#include <grpcpp/impl/service_type.h>
#include <grpcpp/server_context.h>
#include <grpcpp/support/byte_buffer.h>

#include "server/in_flight.h"
#include "server/operate/callers.h"

namespace patchmill {

// A call whose request has arrived. The thread that runs it uses this class.
class RawCall {
 public:
  virtual ~RawCall() = default;

  virtual grpc::ByteBuffer& request() = 0;
  // Frees the bytes of the request. Call it after they are parsed.
  virtual void DropRequest() = 0;
  // Waits for the next message of a request of several, which request() then has. False: there is none any
  // more, or the call has ended. The call's own thread may end it with an error then.
  virtual bool ReadNext() = 0;
  // Who calls: the name of its token or certificate. Empty where nobody says who he is.
  virtual const std::string& caller() const = 0;
  // When the caller's time is up. By the steady clock: the time of day may jump while a call runs.
  virtual std::optional<std::chrono::steady_clock::time_point> deadline() const = 0;
  virtual bool Cancelled() const = 0;  // from any thread
  // Sends a message and waits until it is on its way. False: the other side is gone, or has not taken the
  // message in time.
  virtual bool Write(const google::protobuf::Message& response) = 0;
  virtual bool Write(const grpc::ByteBuffer& response) = 0;  // the bytes of one message
  // Sets the name of the request in the log.
  virtual void SetRequestId(std::string id) = 0;
};

struct RawMethod {
  std::string path;  // "/patchmill.v1.ModelService/CheckModel"
  // Runs in its own thread. The status that it returns ends the call. An exception becomes a status.
  std::function<absl::Status(RawCall&)> run;
};

// A call, as the log and the metrics see it.
struct CallRecord {
  std::int64_t number = 0;  // of the calls of this process
  std::string method, caller, peer;
  std::string request_id;  // of the request, or else of the metadata x-request-id
  double seconds = 0.0;    // from its start, with the time that its request took to arrive
  absl::Status status;     // why it ended; with the true reason where the client sees another one
};
using CallLog = std::function<void(const CallRecord&)>;

// Says who calls, or why the call is refused before its request is read.
using Admission = std::function<absl::StatusOr<std::string>(const Presented&)>;
Presented PresentedBy(const grpc::CallbackServerContext& context);

// What the calls of a service share.
struct CallRules {
  CallLog begins;               // may be empty; without a status
  CallLog ends;                 // may be empty
  Admission admit;              // empty: anybody may call, by the name in the certificate
  double write_seconds = 60.0;  // a client that does not take a response within this time is cut off
};

// A service of these methods; each may send any number of responses. Requests are counted in `in_flight`,
// which must outlive the service. A call that is refused there never runs.
std::unique_ptr<grpc::Service> MakeRawService(std::vector<RawMethod> methods, InFlight& in_flight,
                                              CallRules rules);

}  // namespace patchmill
