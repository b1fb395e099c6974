// The sockets that a server listens on, and its open connections. There are fewer connections than
// descriptors, so that some are left for other uses. This replaces the listener of gRPC, which never accepts
// again after accept() has failed once.
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

// Raises the soft limit of the process on descriptors to the hard limit. Returns how many of them
// connections may take: at most limits::kMaxConnections, and limits::kSpareDescriptors fewer than there are
// (a quarter fewer if there are few).
int RaiseConnectionLimit();

class Listener {
 public:
  // Receives an accepted socket and owns it from then on. The socket does not block and is closed on exec.
  // `listening` is the socket that accepted it.
  using Accepted = std::function<void(int listening, int socket)>;

  // Listens on all of these addresses, at one port. `max_connections` comes from RaiseConnectionLimit.
  // INVALID_ARGUMENT if an address is taken, or if none belongs to this machine.
  static absl::StatusOr<std::unique_ptr<Listener>> Bind(const std::vector<SocketAddress>& addresses,
                                                        std::string_view listen, int max_connections);
  ~Listener();
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  int port() const { return port_; }  // 0 for a Unix socket

  // Accepts connections in its own thread until Stop(). A connection beyond the limit is closed at once.
  void Start(Accepted accepted);
  void Stop();

  // Bytes received over the connection of a peer (PeerName). Nothing if there is none, or if it is not TCP.
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
  std::unordered_map<std::string, int>
      socket_of_;  // by peer; may be closed meanwhile, or belong to another peer
  std::unordered_map<int, std::string> peer_of_;
};

}  // namespace patchmill
