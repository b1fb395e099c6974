// Services whose requests come as bytes: they are counted while they are on their way, and before they are
// parsed. gRPC's own handlers parse first and ask then.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <absl/status/status.h>
#include <google/protobuf/message.h>
#include <grpcpp/impl/service_type.h>
#include <grpcpp/support/byte_buffer.h>

#include "server/in_flight.h"

namespace patchmill {

// A call whose request has come. Used by the thread that runs it.
class RawCall {
 public:
  virtual ~RawCall() = default;

  virtual grpc::ByteBuffer& request() = 0;
  // Frees the bytes of the request, once they are parsed.
  virtual void DropRequest() = 0;
  virtual std::chrono::system_clock::time_point deadline() const = 0;  // max() when there is none
  virtual bool Cancelled() const = 0;                                  // any thread
  // Waits until the message is on its way. False: the other side is gone, or has not taken it in time.
  virtual bool Write(const google::protobuf::Message& response) = 0;
  virtual bool Write(const grpc::ByteBuffer& response) = 0;  // a message's bytes
  // How the log names the call; its method unless told otherwise.
  virtual void SetLabel(std::string label) = 0;
};

struct RawMethod {
  std::string path;  // "/patchmill.v1.ModelService/CheckModel"
  // Runs in a thread of its own; the status it returns ends the call. An exception becomes a status.
  std::function<absl::Status(RawCall&)> run;
};

// Every call once, when it has ended.
struct CallRecord {
  std::string label, peer;
  double seconds = 0.0;  // from its start, the time its request took to come among it
  absl::Status status;
};
using CallLog = std::function<void(const CallRecord&)>;

// A service of these methods, of any number of responses each. Requests are counted in `in_flight`, which
// outlives the service; what is refused there never runs. A client that does not take a response within
// `write_seconds` is cut off.
std::unique_ptr<grpc::Service> MakeRawService(std::vector<RawMethod> methods, InFlight& in_flight,
                                              CallLog log, double write_seconds);

}  // namespace patchmill
