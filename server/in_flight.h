// Limits the bytes of requests and answers: requests on their way to the server, requests that it holds until
// they are answered, and answers until they are written.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <list>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

#include <absl/status/statusor.h>

namespace patchmill {

// Bytes received over the connection of a peer, as gRPC names it, since the connection was opened. Nothing
// if the number is unknown.
using ReceivedBytes = std::function<std::optional<std::uint64_t>(const std::string& peer)>;

class InFlight {
 public:
  // With `received`, a thread measures the bytes on their way every limits::kMeasureMs. If it is empty, only
  // requests that have arrived are counted.
  InFlight(std::size_t limit_bytes, ReceivedBytes received);
  ~InFlight();
  InFlight(const InFlight&) = delete;
  InFlight& operator=(const InFlight&) = delete;

  std::size_t limit_bytes() const { return limit_; }

  // Counts bytes as held until it is destroyed.
  class Hold {
   public:
    Hold() = default;
    Hold(InFlight* from, std::size_t bytes) : from_(from), bytes_(bytes) {}
    Hold(Hold&& other) noexcept : from_(other.from_), bytes_(other.bytes_) { other.from_ = nullptr; }
    Hold& operator=(Hold&& other) noexcept {
      std::swap(from_, other.from_);
      std::swap(bytes_, other.bytes_);
      return *this;
    }
    ~Hold() {
      if (from_ != nullptr) from_->Release(bytes_);
    }

   private:
    InFlight* from_ = nullptr;
    std::size_t bytes_ = 0;
  };
  // Holds `bytes`. RESOURCE_EXHAUSTED: LIMIT_EXCEEDED if they alone exceed the limit, TOO_MANY_BYTES if they
  // do together with the bytes already held. `name` is that of the limit in the error.
  absl::StatusOr<Hold> Take(std::size_t bytes, std::string_view name = "request_bytes_in_flight");

  // Announces a request on its way. `refuse` is called at most once, from another thread and possibly after
  // Arrived. It gets TOO_MANY_BYTES if there are too many bytes, this peer sends the most, and the call is
  // its newest. It gets LIMIT_EXCEEDED if the peer has sent more than all its calls may send, and
  // DEADLINE_EXCEEDED if the request has not arrived within limits::kReceiveSeconds.
  using Refuse = std::function<void(const absl::Status&)>;
  using Id = std::uint64_t;
  Id Expect(const std::string& peer, Refuse refuse);
  // The request has arrived with `bytes`, or will not arrive (0). Call it once for each Expect.
  void Arrived(Id id, std::size_t bytes);

 private:
  using Clock = std::chrono::steady_clock;
  struct Expected {
    Id id = 0;
    Clock::time_point since;
    Refuse refuse;
  };
  struct Peer {
    std::uint64_t counted = 0;     // received bytes that belong to no request on its way
    std::uint64_t came = 0;        // received bytes beyond `counted`
    std::uint64_t on_the_way = 0;  // of `came`, at most what the calls of this peer may send
    std::uint64_t forgiven = 0;    // bytes counted for refused calls that may belong to other calls
    std::list<Expected> calls;     // oldest first
  };

  void Release(std::size_t bytes);
  void Watch();
  void Measure(Peer& peer, const std::string& name) const;
  // The requests to refuse now, each with its status.
  using Refused = std::list<std::pair<Refuse, absl::Status>>;
  Refused Overdue();
  Refused Oversize();
  Refused Excess();
  Refused Forgiven();
  static void RefuseAll(Peer& peer, const absl::Status& status, Refused& refused);

  const std::size_t limit_;
  const ReceivedBytes received_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::size_t held_ = 0;
  Id last_id_ = 0;
  std::map<std::string, Peer> peers_;
  std::map<Id, std::string> peer_of_;
  bool stop_ = false;
  std::thread watch_;
};

}  // namespace patchmill
