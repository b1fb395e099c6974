#include "server/listen_address.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <memory>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/un.h>

#include "core/base/status.h"

namespace patchmill {
namespace {

constexpr std::string_view kUnix = "unix:";

absl::Status BadAddress(std::string_view listen, std::string_view why) {
  return absl::InvalidArgumentError(fmt::format("cannot listen on {}: {}", listen, why));
}

absl::StatusOr<std::vector<SocketAddress>> UnixAddress(std::string_view listen) {
  std::string_view path = listen.substr(kUnix.size());
  if (path.starts_with("//")) path.remove_prefix(2);
  SocketAddress address;
  auto& socket = reinterpret_cast<sockaddr_un&>(address.storage);
  if (path.empty() || path.size() >= sizeof socket.sun_path) {
    return BadAddress(listen, fmt::format("the path must have 1 to {} bytes", sizeof socket.sun_path - 1));
  }
  socket.sun_family = AF_UNIX;
  std::memcpy(socket.sun_path, path.data(), path.size());
  address.size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + path.size() + 1);
  return std::vector<SocketAddress>{address};
}

bool IsPort(std::string_view port) {
  return !port.empty() && port.size() <= 5 &&
         std::all_of(port.begin(), port.end(), [](char c) { return c >= '0' && c <= '9'; }) &&
         std::stoi(std::string(port)) <= 65535;
}

bool IsWildcard(std::string_view host) { return host == "0.0.0.0" || host == "::"; }

bool SameAddress(const SocketAddress& a, const SocketAddress& b) {
  return a.size == b.size && std::memcmp(&a.storage, &b.storage, a.size) == 0;
}

// Nothing for other families of addresses.
const in6_addr* V6(const SocketAddress& address) {
  return address.family() == AF_INET6 ? &reinterpret_cast<const sockaddr_in6&>(address.storage).sin6_addr
                                      : nullptr;
}

bool IsMapped(const in6_addr& v6) { return IN6_IS_ADDR_V4MAPPED(&v6); }

}  // namespace

absl::StatusOr<std::vector<SocketAddress>> ResolveListenAddress(std::string_view listen) {
  if (listen.starts_with(kUnix)) return UnixAddress(listen);
  const std::size_t colon = listen.rfind(':');
  std::string host(listen.substr(0, colon));
  const std::string port(colon == std::string_view::npos ? "" : listen.substr(colon + 1));
  if (!IsPort(port)) return BadAddress(listen, "must be HOST:PORT with a port of 0 to 65535");
  const bool bracketed = host.size() > 2 && host.front() == '[' && host.back() == ']';
  if (bracketed) host = host.substr(1, host.size() - 2);
  if (host.empty() || (!bracketed && host.find(':') != std::string::npos)) {
    return BadAddress(listen, "must be HOST:PORT, with an IPv6 address in brackets");
  }
  addrinfo hints{};
  hints.ai_family = bracketed ? AF_INET6 : AF_UNSPEC;
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
  addrinfo* found = nullptr;
  if (const int fault = getaddrinfo(host.c_str(), port.c_str(), &hints, &found); fault != 0) {
    return BadAddress(listen, gai_strerror(fault));
  }
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> owner(found, &freeaddrinfo);
  std::vector<SocketAddress> addresses;
  for (const addrinfo* info = found; info != nullptr; info = info->ai_next) {
    SocketAddress address;
    std::memcpy(&address.storage, info->ai_addr, info->ai_addrlen);
    address.size = info->ai_addrlen;
    const bool twice = std::any_of(addresses.begin(), addresses.end(),
                                   [&](const SocketAddress& other) { return SameAddress(other, address); });
    if (!twice) addresses.push_back(address);
  }
  if (!IsWildcard(host)) return addresses;
  // One IPv6 socket takes both families. The IPv4 address is for machines without IPv6.
  SocketAddress both, only_v4;
  auto& v6 = reinterpret_cast<sockaddr_in6&>(both.storage);
  auto& v4 = reinterpret_cast<sockaddr_in&>(only_v4.storage);
  v6.sin6_family = AF_INET6;
  v4.sin_family = AF_INET;
  v6.sin6_port = v4.sin_port = htons(static_cast<std::uint16_t>(std::stoi(port)));
  both.size = sizeof v6;
  only_v4.size = sizeof v4;
  return std::vector<SocketAddress>{both, only_v4};
}

bool IsLoopback(const SocketAddress& address) {
  if (address.family() == AF_UNIX) return true;
  if (address.family() == AF_INET) {
    return ntohl(reinterpret_cast<const sockaddr_in&>(address.storage).sin_addr.s_addr) >> 24 == 127;
  }
  const in6_addr* v6 = V6(address);
  if (v6 == nullptr) return false;
  return IsMapped(*v6) ? v6->s6_addr[12] == 127 : IN6_IS_ADDR_LOOPBACK(v6);
}

std::string PeerName(const SocketAddress& address) {
  char text[INET6_ADDRSTRLEN] = {};
  if (address.family() == AF_INET) {
    const auto& v4 = reinterpret_cast<const sockaddr_in&>(address.storage);
    inet_ntop(AF_INET, &v4.sin_addr, text, sizeof text);
    return fmt::format("ipv4:{}:{}", text, ntohs(v4.sin_port));
  }
  const in6_addr* v6 = V6(address);
  if (v6 == nullptr) return "";
  const int port = ntohs(reinterpret_cast<const sockaddr_in6&>(address.storage).sin6_port);
  if (IsMapped(*v6)) {
    inet_ntop(AF_INET, &v6->s6_addr[12], text, sizeof text);
    return fmt::format("ipv4:{}:{}", text, port);
  }
  inet_ntop(AF_INET6, v6, text, sizeof text);
  return fmt::format("ipv6:%5B{}%5D:{}", text, port);
}

}  // namespace patchmill
