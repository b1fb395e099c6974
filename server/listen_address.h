// Turns the address of the command line into socket addresses.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <absl/status/statusor.h>
#include <sys/socket.h>

namespace patchmill {

struct SocketAddress {
  sockaddr_storage storage{};
  socklen_t size = 0;

  const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&storage); }
  sockaddr* get() { return reinterpret_cast<sockaddr*>(&storage); }
  int family() const { return storage.ss_family; }
};

// Reads "HOST:PORT" or "unix:PATH". HOST is a name, an IPv4 address, or an IPv6 address in brackets; PORT is
// 0 to 65535. A name gives all its addresses. The host 0.0.0.0 or [::] means all addresses of the machine,
// of both families if it has both. INVALID_ARGUMENT for anything else.
absl::StatusOr<std::vector<SocketAddress>> ResolveListenAddress(std::string_view listen);

// Whether only this machine can reach the address: 127.0.0.0/8, ::1, a Unix socket.
bool IsLoopback(const SocketAddress& address);

// The address as gRPC names the peer of a call: "ipv4:127.0.0.1:50051", "ipv6:%5B::1%5D:50051". Empty for
// other families. IPv4 addresses mapped into IPv6 count as IPv4.
std::string PeerName(const SocketAddress& address);

}  // namespace patchmill
