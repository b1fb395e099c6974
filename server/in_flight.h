// The bytes that a server holds: of requests on their way to it, and from their arrival until they are
// answered; of answers until they are written.
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

// Bytes that have come in over the connection of a peer, as gRPC names it, since it was opened; nothing where
// that cannot be told.
using ReceivedBytes = std::function<std::optional<std::uint64_t>(const std::string& peer)>;

class InFlight {
 public:
  // With `received` (may be empty: then only what has arrived is counted) a thread measures every
  // limits::kMeasureMs what is on its way.
  InFlight(std::size_t limit_bytes, ReceivedBytes received);
  ~InFlight();
  InFlight(const InFlight&) = delete;
  InFlight& operator=(const InFlight&) = delete;

  std::size_t limit_bytes() const { return limit_; }

  // Bytes that are held until it is destroyed.
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
  // RESOURCE_EXHAUSTED: LIMIT_EXCEEDED where the bytes alone are too many, TOO_MANY_BYTES where they are with
  // what is held.
  // `name`: how the error names them.
  absl::StatusOr<Hold> Take(std::size_t bytes, std::string_view name = "request_bytes_in_flight");

  // A request on its way. `refuse` is called at most once, from another thread and possibly still after
  // Arrived: with TOO_MANY_BYTES when there are too many bytes and this peer sends the most, of several calls
  // of it for the newest; with LIMIT_EXCEEDED when the peer has sent more than all its calls may; with
  // DEADLINE_EXCEEDED when the request has not come after limits::kReceiveSeconds.
  using Refuse = std::function<void(const absl::Status&)>;
  using Id = std::uint64_t;
  Id Expect(const std::string& peer, Refuse refuse);
  // The request has come, with that many bytes, or will not come (0). Once for each Expect.
  void Arrived(Id id, std::size_t bytes);

 private:
  using Clock = std::chrono::steady_clock;
  struct Expected {
    Id id = 0;
    Clock::time_point since;
    Refuse refuse;
  };
  struct Peer {
    std::uint64_t counted = 0;     // of its received bytes, those that are no request on its way
    std::uint64_t came = 0;        // beyond those
    std::uint64_t on_the_way = 0;  // of these, no more than its calls may send
    std::uint64_t forgiven = 0;    // counted as of calls that were refused, though they may be of others
    std::list<Expected> calls;     // oldest first
  };

  void Release(std::size_t bytes);
  void Watch();
  void Measure(Peer& peer, const std::string& name) const;
  // Those to be refused now, and with what.
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
