#include "server/listener.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>

#include <fmt/format.h>
#include <linux/tcp.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include "core/base/status.h"
#include "server/limits.h"
#include "server/operate/log.h"

namespace patchmill {
namespace {

constexpr int kBacklog = 1024;
constexpr int kAgainMs = 50;  // wait after accept() failed for lack of descriptors or memory

bool Connects(const SocketAddress& address) {
  const int probe = socket(address.family(), SOCK_STREAM | SOCK_CLOEXEC, 0);
  const bool connected = probe >= 0 && connect(probe, address.get(), address.size) == 0;
  if (probe >= 0) close(probe);
  return connected;
}

// Removes the socket file that a killed server has left.
void RemoveStaleSocket(const SocketAddress& address, const std::string& path) {
  struct stat file {};
  if (lstat(path.c_str(), &file) == 0 && S_ISSOCK(file.st_mode) && !Connects(address)) unlink(path.c_str());
}

void SetPort(SocketAddress& address, int port) {
  if (address.family() == AF_INET) reinterpret_cast<sockaddr_in&>(address.storage).sin_port = htons(port);
  if (address.family() == AF_INET6) reinterpret_cast<sockaddr_in6&>(address.storage).sin6_port = htons(port);
}

int PortOf(int socket) {
  SocketAddress address;
  address.size = sizeof address.storage;
  if (getsockname(socket, address.get(), &address.size) != 0) return 0;
  if (address.family() == AF_INET) return ntohs(reinterpret_cast<sockaddr_in&>(address.storage).sin_port);
  if (address.family() == AF_INET6) return ntohs(reinterpret_cast<sockaddr_in6&>(address.storage).sin6_port);
  return 0;
}

// An IPv6 socket for all addresses also takes the IPv4 ones.
bool IsAnyV6(const SocketAddress& address) {
  return address.family() == AF_INET6 &&
         IN6_IS_ADDR_UNSPECIFIED(&reinterpret_cast<const sockaddr_in6&>(address.storage).sin6_addr);
}

bool IsAnyV4(const SocketAddress& address) {
  return address.family() == AF_INET &&
         reinterpret_cast<const sockaddr_in&>(address.storage).sin_addr.s_addr == htonl(INADDR_ANY);
}

}  // namespace

int RaiseConnectionLimit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return 1024 - limits::kSpareDescriptors;
  if (limit.rlim_cur < limit.rlim_max) {
    rlimit raised = limit;
    raised.rlim_cur = limit.rlim_max;
    if (setrlimit(RLIMIT_NOFILE, &raised) == 0) limit = raised;
  }
  const auto descriptors =
      static_cast<int>(std::min<rlim_t>(limit.rlim_cur, limits::kMaxConnections + limits::kSpareDescriptors));
  return descriptors - std::min(limits::kSpareDescriptors, descriptors / 4);
}

absl::StatusOr<std::unique_ptr<Listener>> Listener::Bind(const std::vector<SocketAddress>& addresses,
                                                         std::string_view listen, int max_connections) {
  std::unique_ptr<Listener> listener(new Listener(max_connections));
  listener->wake_ = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  absl::Status last = absl::InvalidArgumentError(fmt::format("cannot listen on {}", listen));
  bool any = false;
  for (const SocketAddress& address : addresses) {
    if (IsAnyV4(address) && any) continue;
    const absl::Status opened = listener->Open(address, listen);
    any = any || (opened.ok() && IsAnyV6(address));
    if (opened.ok()) continue;
    last = opened;
    if (absl::IsAlreadyExists(opened)) break;  // listening on some addresses of a name only would mislead
    // A machine without IPv6 may still know the IPv6 address of a name.
  }
  if (absl::IsAlreadyExists(last) || listener->sockets_.empty()) {
    return absl::InvalidArgumentError(std::string(last.message()));
  }
  return listener;
}

absl::Status Listener::Open(SocketAddress address, std::string_view listen) {
  const auto fail = [&](int socket) {
    const int fault = errno;
    if (socket >= 0) close(socket);
    const std::string why = fmt::format("cannot listen on {}: {}", listen, std::strerror(fault));
    return fault == EADDRINUSE ? absl::AlreadyExistsError(why) : absl::InvalidArgumentError(why);
  };
  const int listening = socket(address.family(), SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (listening < 0) return fail(listening);
  if (address.family() == AF_UNIX) {
    unix_path_ = reinterpret_cast<const sockaddr_un&>(address.storage).sun_path;
    RemoveStaleSocket(address, unix_path_);
  } else {
    const int on = 1, only_v6 = IsAnyV6(address) ? 0 : 1;
    // The port of a server that was just stopped can be taken. Two servers at one port are still refused.
    setsockopt(listening, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    if (address.family() == AF_INET6)
      setsockopt(listening, IPPROTO_IPV6, IPV6_V6ONLY, &only_v6, sizeof only_v6);
    if (port_ != 0) SetPort(address, port_);
  }
  if (bind(listening, address.get(), address.size) != 0 || ::listen(listening, kBacklog) != 0)
    return fail(listening);
  sockets_.push_back(listening);
  port_ = PortOf(listening);
  return absl::OkStatus();
}

Listener::~Listener() {
  Stop();
  if (wake_ >= 0) close(wake_);
}

void Listener::Start(Accepted accepted) {
  thread_ = std::thread([this, accepted = std::move(accepted)] { Run(accepted); });
}

void Listener::Stop() {
  if (thread_.joinable()) {
    const std::uint64_t one = 1;
    [[maybe_unused]] const auto written = write(wake_, &one, sizeof one);
    thread_.join();
  }
  for (const int socket : sockets_) close(socket);
  if (!unix_path_.empty() && !sockets_.empty()) unlink(unix_path_.c_str());
  sockets_.clear();
}

void Listener::Run(const Accepted& accepted) {
  std::vector<pollfd> waits = {{wake_, POLLIN, 0}};
  for (const int socket : sockets_) waits.push_back({socket, POLLIN, 0});
  bool starved = false;
  for (;;) {
    // Without free descriptors the thread waits for the wake-up only, and tries again a little later.
    poll(waits.data(), starved ? 1 : waits.size(), starved ? kAgainMs : -1);
    if (waits.front().revents != 0) return;
    starved = false;
    for (std::size_t k = 1; k < waits.size() && !starved; ++k) starved = !AcceptOne(waits[k].fd, accepted);
  }
}

// False if there is no descriptor or no memory for the connection.
bool Listener::AcceptOne(int listening, const Accepted& accepted) {
  SocketAddress peer;
  peer.size = sizeof peer.storage;
  const int socket = accept4(listening, peer.get(), &peer.size, SOCK_NONBLOCK | SOCK_CLOEXEC);
  if (socket < 0) return errno != EMFILE && errno != ENFILE && errno != ENOBUFS && errno != ENOMEM;
  // A socket gets the lowest free number. A number this high means that as many are open.
  if (socket >= max_connections_) {
    close(socket);
    if (refused_++ % 1000 == 0) {
      Log(LogLevel::kWarning,
          fmt::format("{} connections are open, as many as there may be; {} refused so far", max_connections_,
                      refused_));
    }
    return true;
  }
  const int on = 1;
  setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  Remember(socket, peer);
  accepted(listening, socket);
  return true;
}

void Listener::Remember(int socket, const SocketAddress& peer) {
  const std::string name = PeerName(peer);
  if (name.empty()) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  std::string& last = peer_of_[socket];
  if (const auto at = socket_of_.find(last); at != socket_of_.end() && at->second == socket)
    socket_of_.erase(at);
  socket_of_[name] = socket;
  last = name;
}

std::optional<std::uint64_t> Listener::ReceivedBytes(const std::string& peer) {
  int socket = -1;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto at = socket_of_.find(peer);
    if (at == socket_of_.end()) return std::nullopt;
    socket = at->second;
  }
  // gRPC may have closed the socket meanwhile, and its number may belong to another one.
  SocketAddress address;
  address.size = sizeof address.storage;
  if (getpeername(socket, address.get(), &address.size) != 0 || PeerName(address) != peer)
    return std::nullopt;
  tcp_info info{};
  socklen_t size = sizeof info;
  if (getsockopt(socket, IPPROTO_TCP, TCP_INFO, &info, &size) != 0 ||
      size < offsetof(tcp_info, tcpi_bytes_received) + sizeof info.tcpi_bytes_received) {
    return std::nullopt;
  }
  return info.tcpi_bytes_received;
}

}  // namespace patchmill
