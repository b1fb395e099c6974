// The sockets a server listens on, and its open connections: fewer than there are descriptors, so that it
// always has some for its own. gRPC's own listener never accepts again after accept() has failed once.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <unordered_map>
#include <vector>

#include <absl/status/statusor.h>

#include "server/listen_address.h"

namespace patchmill {

// How many descriptors connections may take, having raised the process's soft limit on descriptors to its
// hard one: at most limits::kMaxConnections and limits::kSpareDescriptors fewer than there are (a quarter
// fewer where these are few).
int RaiseConnectionLimit();

class Listener {
 public:
  // Gets an accepted socket and owns it from then on; not blocking, closed on exec. `listening`: the one it
  // came in at.
  using Accepted = std::function<void(int listening, int socket)>;

  // Listens at all of these addresses, at one port; `max_connections` as RaiseConnectionLimit gives it.
  // INVALID_ARGUMENT when an address is taken, or none is one of this machine.
  static absl::StatusOr<std::unique_ptr<Listener>> Bind(const std::vector<SocketAddress>& addresses,
                                                        std::string_view listen, int max_connections);
  ~Listener();
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  int port() const { return port_; }  // 0 for a Unix socket

  // Accepts in a thread of its own until Stop(). A connection beyond the limit is closed at once.
  void Start(Accepted accepted);
  void Stop();

  // Of the connection of that peer (PeerName); nothing where there is none, or it is no TCP connection.
  std::optional<std::uint64_t> ReceivedBytes(const std::string& peer);

 private:
  explicit Listener(int max_connections) : max_connections_(max_connections) {}
  absl::Status Open(SocketAddress address, std::string_view listen);
  void Run(const Accepted& accepted);
  bool AcceptOne(int listening, const Accepted& accepted);
  void Remember(int socket, const SocketAddress& peer);

  const int max_connections_;
  int port_ = 0;
  std::vector<int> sockets_;
  std::string unix_path_;
  int wake_ = -1;
  std::thread thread_;
  std::uint64_t refused_ = 0;

  std::mutex mutex_;
  std::unordered_map<std::string, int> socket_of_;  // by peer; may be closed meanwhile, or another's
  std::unordered_map<int, std::string> peer_of_;
};

}  // namespace patchmill
