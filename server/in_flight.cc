#include "server/in_flight.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "server/errors.h"
#include "server/limits.h"

namespace patchmill {
namespace {

// Of one call: its message, and a quarter for the frames, TLS and headers around it.
constexpr std::size_t kMostOnTheWay = limits::kMaxMessageBytes + limits::kMaxMessageBytes / 4;

}  // namespace

InFlight::InFlight(std::size_t limit_bytes, ReceivedBytes received)
    : limit_(limit_bytes), received_(std::move(received)) {
  if (received_) watch_ = std::thread([this] { Watch(); });
}

InFlight::~InFlight() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  if (watch_.joinable()) watch_.join();
}

absl::StatusOr<InFlight::Hold> InFlight::Take(std::size_t bytes, std::string_view name) {
  const auto limit = static_cast<double>(limit_);
  if (bytes > limit_) return LimitError(name, limit, static_cast<double>(bytes));
  const std::lock_guard<std::mutex> lock(mutex_);
  if (held_ + bytes > limit_) return TooManyBytesError(limit, static_cast<double>(held_ + bytes), name);
  held_ += bytes;
  return Hold(this, bytes);
}

void InFlight::Release(std::size_t bytes) {
  const std::lock_guard<std::mutex> lock(mutex_);
  held_ -= bytes;
}

InFlight::Id InFlight::Expect(const std::string& name, Refuse refuse) {
  std::unique_lock<std::mutex> lock(mutex_);
  const auto [at, fresh] = peers_.try_emplace(name);
  if (fresh && received_) at->second.counted = received_(name).value_or(0);
  const Id id = ++last_id_;
  at->second.calls.push_back({id, Clock::now(), std::move(refuse)});
  peer_of_.emplace(id, name);
  lock.unlock();
  changed_.notify_all();
  return id;
}

void InFlight::Arrived(Id id, std::size_t bytes) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto name = peer_of_.find(id);
  const auto at = peers_.find(name->second);
  peer_of_.erase(name);
  Peer& peer = at->second;
  peer.calls.remove_if([id](const Expected& call) { return call.id == id; });
  if (peer.calls.empty()) {
    peers_.erase(at);
    return;
  }
  peer.counted += bytes;
  peer.on_the_way -= std::min<std::uint64_t>(peer.on_the_way, bytes);
}

void InFlight::Measure(Peer& peer, const std::string& name) const {
  const std::uint64_t received = received_(name).value_or(0);
  peer.came = received - std::min(received, peer.counted);
  peer.on_the_way = std::min<std::uint64_t>(peer.came, peer.calls.size() * limits::kMaxMessageBytes);
}

InFlight::Refused InFlight::Overdue() {
  const Clock::time_point latest = Clock::now() - std::chrono::seconds(limits::kReceiveSeconds);
  Refused refused;
  for (auto& [name, peer] : peers_) {
    for (Expected& call : peer.calls) {
      if (call.since > latest || !call.refuse) continue;
      refused.emplace_back(std::exchange(call.refuse, nullptr),
                           absl::DeadlineExceededError(
                               fmt::format("the request has not come within {} s", limits::kReceiveSeconds)));
    }
  }
  return refused;
}

void InFlight::RefuseAll(Peer& peer, const absl::Status& status, Refused& refused) {
  for (Expected& call : peer.calls) {
    if (call.refuse) refused.emplace_back(std::exchange(call.refuse, nullptr), status);
  }
  peer.counted += std::exchange(peer.came, 0);
  peer.on_the_way = peer.forgiven = 0;
}

// gRPC reads a message whole, however long it says that it is, before it looks at its limit.
InFlight::Refused InFlight::Oversize() {
  Refused refused;
  for (auto& [name, peer] : peers_) {
    if (peer.came <= peer.calls.size() * kMostOnTheWay) continue;
    const auto most = static_cast<double>(limits::kMaxMessageBytes * peer.calls.size());
    RefuseAll(peer, LimitError("message_bytes", most, static_cast<double>(peer.came)), refused);
  }
  return refused;
}

InFlight::Refused InFlight::Excess() {
  Refused refused;
  std::uint64_t total = held_;
  for (const auto& [name, peer] : peers_) total += peer.on_the_way;
  while (total > limit_) {
    Peer* most = nullptr;
    for (auto& [name, peer] : peers_) {
      if (peer.on_the_way > (most == nullptr ? 0 : most->on_the_way)) most = &peer;
    }
    if (most == nullptr) break;
    // Bytes are known per connection, not per call. So each call of a peer counts as an equal share.
    const auto open = std::find_if(most->calls.rbegin(), most->calls.rend(),
                                   [](const Expected& call) { return call.refuse != nullptr; });
    const std::uint64_t share =
        open == most->calls.rend() ? most->on_the_way : most->on_the_way / most->calls.size() + 1;
    if (open != most->calls.rend()) {
      refused.emplace_back(std::exchange(open->refuse, nullptr),
                           TooManyBytesError(static_cast<double>(limit_), static_cast<double>(total)));
    }
    total -= std::min(share, most->on_the_way);
    most->counted += std::min(share, most->on_the_way);
    most->came -= std::min(share, most->on_the_way);
    most->forgiven += std::min(share, most->on_the_way);
    most->on_the_way -= std::min(share, most->on_the_way);
  }
  return refused;
}

// A peer could have new calls refused that have sent nothing, in place of those that have sent much. What was
// counted as theirs may come to the limit once; then the peer with most of it loses all its calls on the way.
InFlight::Refused InFlight::Forgiven() {
  Refused refused;
  std::uint64_t total = 0;
  for (const auto& [name, peer] : peers_) total += peer.forgiven;
  while (total > limit_) {
    Peer& most = std::max_element(peers_.begin(), peers_.end(), [](const auto& a, const auto& b) {
                   return a.second.forgiven < b.second.forgiven;
                 })->second;
    const absl::Status status = TooManyBytesError(static_cast<double>(limit_), static_cast<double>(total));
    total -= most.forgiven;
    RefuseAll(most, status, refused);
  }
  return refused;
}

void InFlight::Watch() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!stop_) {
    if (peers_.empty()) {
      changed_.wait(lock, [this] { return stop_ || !peers_.empty(); });
      continue;
    }
    for (auto& [name, peer] : peers_) Measure(peer, name);
    Refused refused = Overdue();
    refused.splice(refused.end(), Oversize());
    refused.splice(refused.end(), Excess());
    refused.splice(refused.end(), Forgiven());
    lock.unlock();
    for (const auto& [refuse, status] : refused) refuse(status);
    refused.clear();
    lock.lock();
    changed_.wait_for(lock, std::chrono::milliseconds(limits::kMeasureMs), [this] { return stop_; });
  }
}

}  // namespace patchmill
