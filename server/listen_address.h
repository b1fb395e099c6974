// Where a server listens, as the command line says it, made socket addresses.
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

// "HOST:PORT" with a port of 0 to 65535 and a name, an IPv4 address, or an IPv6 one in brackets for the host;
// or "unix:PATH". Every address of a name. A host of 0.0.0.0 or [::] is all addresses of the machine, of both
// families where it has both. INVALID_ARGUMENT for anything else.
absl::StatusOr<std::vector<SocketAddress>> ResolveListenAddress(std::string_view listen);

// Whether only this machine reaches it: 127.0.0.0/8, ::1, a Unix socket.
bool IsLoopback(const SocketAddress& address);

// As gRPC names the peer of a call: "ipv4:127.0.0.1:50051", "ipv6:%5B::1%5D:50051"; empty for other families.
// IPv4 addresses mapped into IPv6 are IPv4.
std::string PeerName(const SocketAddress& address);

}  // namespace patchmill
