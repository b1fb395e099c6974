#include "server/listener.h"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <set>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include "server/limits.h"
#include "tests/service/process.h"
#include "tests/service/status_matchers.h"

namespace patchmill {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using testing::StatusIs;

std::vector<SocketAddress> Resolve(const std::string& listen) {
  const auto addresses = ResolveListenAddress(listen);
  EXPECT_TRUE(addresses.ok()) << addresses.status();
  return addresses.ok() ? *addresses : std::vector<SocketAddress>();
}

bool AllLoopback(const std::string& listen) {
  const std::vector<SocketAddress> addresses = Resolve(listen);
  return !addresses.empty() && std::all_of(addresses.begin(), addresses.end(), IsLoopback);
}

TEST(ListenAddress, OnlyThisMachineReachesLoopback) {
  for (const char* listen : {"127.0.0.1:50051", "127.8.9.10:0", "[::1]:50051", "localhost:1",
                             "unix:/tmp/x.sock", "[::ffff:127.0.0.1]:5"}) {
    EXPECT_TRUE(AllLoopback(listen)) << listen;
  }
  for (const char* listen : {"0.0.0.0:50051", "[::]:50051", "192.0.2.1:1", "128.0.0.1:1", "[2001:db8::1]:1",
                             "[::ffff:192.0.2.1]:5", "0.0.0.0:0"}) {
    EXPECT_FALSE(AllLoopback(listen)) << listen;
  }
}

TEST(ListenAddress, WhatIsNoAddressIsRefused) {
  for (const char* listen : {"127.0.0.1", "127.0.0.1:", "127.0.0.1:65536", "127.0.0.1:99999999999",
                             "127.0.0.1:-1", "127.0.0.1:http", "", ":", ":50051", "::1:50051",
                             "[127.0.0.1]:5", "no such host:1", "unix:", "[]:1"}) {
    EXPECT_THAT(ResolveListenAddress(listen).status(),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("cannot listen on ")))
        << listen;
  }
  EXPECT_FALSE(ResolveListenAddress("unix:/" + std::string(200, 'x')).ok());
}

// As gRPC writes them: the keys by which a call finds its connection.
TEST(ListenAddress, PeersAreNamedAsGrpcDoes) {
  EXPECT_EQ(PeerName(Resolve("192.0.2.7:50051").front()), "ipv4:192.0.2.7:50051");
  EXPECT_EQ(PeerName(Resolve("[::ffff:192.0.2.7]:50051").front()), "ipv4:192.0.2.7:50051");
  EXPECT_EQ(PeerName(Resolve("[2001:db8::1]:9").front()), "ipv6:%5B2001:db8::1%5D:9");
  EXPECT_EQ(PeerName(Resolve("unix:/tmp/x").front()), "");
}

// Keeps what it is given, as gRPC would.
class Accepting {
 public:
  Accepting(const std::string& listen, int max_connections) {
    auto bound = Listener::Bind(Resolve(listen), listen, max_connections);
    EXPECT_TRUE(bound.ok()) << bound.status();
    listener_ = *std::move(bound);
    listener_->Start([this](int, int socket) {
      const std::lock_guard<std::mutex> lock(mutex_);
      sockets_.push_back(socket);
    });
  }
  ~Accepting() {
    listener_->Stop();
    CloseAll();
  }
  Listener& listener() { return *listener_; }
  std::string target(const std::string& host) { return fmt::format("{}:{}", host, listener_->port()); }
  std::size_t open() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return sockets_.size();
  }
  bool WaitFor(std::size_t count) {
    for (int k = 0; k < 500 && open() < count; ++k) std::this_thread::sleep_for(2ms);
    return open() == count;
  }
  void CloseAll() {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (const int socket : sockets_) close(socket);
    sockets_.clear();
  }

 private:
  std::unique_ptr<Listener> listener_;
  std::mutex mutex_;
  std::vector<int> sockets_;
};

// A client's socket; -1 where nobody listens.
class Client {
 public:
  explicit Client(const std::string& target) {
    const SocketAddress address = Resolve(target).front();
    socket_ = socket(address.family(), SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (connect(socket_, address.get(), address.size) == 0) return;
    close(socket_);
    socket_ = -1;
  }
  Client(const Client&) = delete;
  ~Client() {
    if (socket_ >= 0) close(socket_);
  }
  bool connected() const { return socket_ >= 0; }
  void Send(std::size_t bytes) const {
    const std::string text(bytes, 'x');
    for (std::size_t sent = 0; sent < bytes;) {
      const ssize_t n = write(socket_, text.data() + sent, bytes - sent);
      if (n <= 0) return;
      sent += static_cast<std::size_t>(n);
    }
  }
  bool ClosedByPeer() const {
    char byte;
    return recv(socket_, &byte, 1, 0) <= 0;
  }
  std::string Name() const {
    SocketAddress own;
    own.size = sizeof own.storage;
    getsockname(socket_, own.get(), &own.size);
    return PeerName(own);
  }

 private:
  int socket_ = -1;
};

TEST(Listener, TakesAllAddressesOfTheMachineAndOnePortOnce) {
  Accepting any("0.0.0.0:0", 1000);
  EXPECT_TRUE(Client(any.target("127.0.0.1")).connected());
  const Client v6(any.target("[::1]"));  // where the machine has IPv6
  EXPECT_TRUE(any.WaitFor(v6.connected() ? 2 : 1));
  const std::string taken = any.target("127.0.0.1");
  EXPECT_THAT(Listener::Bind(Resolve(taken), taken, 1000).status(),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("in use")));
  const std::string foreign = "192.0.2.1:0";
  EXPECT_THAT(Listener::Bind(Resolve(foreign), foreign, 1000).status(),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("cannot listen on 192.0.2.1:0")));
}

TEST(Listener, AUnixSocketIsTakenOverFromTheDeadOnly) {
  const testing::TempDir dir;
  const std::string listen = "unix:" + dir / "socket";
  {
    Accepting alive(listen, 1000);
    EXPECT_TRUE(Client(listen).connected());
    EXPECT_TRUE(alive.WaitFor(1));
    EXPECT_FALSE(Listener::Bind(Resolve(listen), listen, 1000).ok());
    EXPECT_TRUE(Client(listen).connected());
  }
  EXPECT_TRUE(dir.Names().empty());
  const SocketAddress address = Resolve(listen).front();
  const int dead = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  ASSERT_EQ(bind(dead, address.get(), address.size), 0);
  close(dead);  // the file stays
  Accepting again(listen, 1000);
  EXPECT_TRUE(Client(listen).connected());
}

// So many that no descriptor up to the limit is free, then none: what is beyond is closed at once, and what
// comes after they are gone is taken again.
TEST(Listener, ClosesWhatIsBeyondItsLimitAndAcceptsAgain) {
  const int next = dup(0);  // the lowest free descriptor
  close(next);
  constexpr int kMost = 60;
  Accepting accepting("127.0.0.1:0", next + kMost);
  std::vector<std::unique_ptr<Client>> clients;
  // The clients use up descriptors too: one is accepted before the others come.
  clients.push_back(std::make_unique<Client>(accepting.target("127.0.0.1")));
  ASSERT_TRUE(accepting.WaitFor(1));
  for (int k = 1; k < kMost + 40; ++k)
    clients.push_back(std::make_unique<Client>(accepting.target("127.0.0.1")));
  EXPECT_TRUE(clients.back()->ClosedByPeer());
  EXPECT_LT(accepting.open(), static_cast<std::size_t>(kMost));
  EXPECT_GT(accepting.open(), 0u);
  clients.clear();
  accepting.CloseAll();
  Client late(accepting.target("127.0.0.1"));
  EXPECT_TRUE(accepting.WaitFor(1));
}

TEST(Listener, AcceptsAgainAfterTheProcessHadNoDescriptorLeft) {
  Accepting accepting("127.0.0.1:0", 1'000'000);
  Client client(accepting.target("127.0.0.1"));
  ASSERT_TRUE(accepting.WaitFor(1));
  rlimit usual{};
  getrlimit(RLIMIT_NOFILE, &usual);
  const Client waiting(accepting.target("127.0.0.1"));  // may be accepted before the limit is set
  ASSERT_TRUE(accepting.WaitFor(2));
  const int next = dup(0);
  close(next);
  const SocketAddress address = Resolve(accepting.target("127.0.0.1")).front();
  const int socket_of_client = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  rlimit none = usual;
  none.rlim_cur = static_cast<rlim_t>(socket_of_client) + 1;  // accept() fails from here on
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &none), 0);
  EXPECT_EQ(connect(socket_of_client, address.get(), address.size), 0);  // it waits in the queue
  std::this_thread::sleep_for(150ms);
  EXPECT_EQ(accepting.open(), 2u);
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &usual), 0);
  EXPECT_TRUE(accepting.WaitFor(3));
  close(socket_of_client);
}

TEST(Listener, TellsWhatHasComeFromAPeer) {
  Accepting accepting("127.0.0.1:0", 1000);
  const Client one(accepting.target("127.0.0.1")), two(accepting.target("127.0.0.1"));
  ASSERT_TRUE(accepting.WaitFor(2));
  const auto eventually = [&](const Client& client, std::uint64_t bytes) {
    for (int k = 0; k < 500; ++k) {
      if (accepting.listener().ReceivedBytes(client.Name()) == bytes) return true;
      std::this_thread::sleep_for(2ms);
    }
    return false;
  };
  one.Send(1000);
  two.Send(50'000);
  EXPECT_TRUE(eventually(one, 1000));
  EXPECT_TRUE(eventually(two, 50'000));
  one.Send(234);
  EXPECT_TRUE(eventually(one, 1234));
  EXPECT_EQ(accepting.listener().ReceivedBytes("ipv4:127.0.0.1:1"), std::nullopt);
  accepting.CloseAll();
  EXPECT_EQ(accepting.listener().ReceivedBytes(one.Name()), std::nullopt);
}

TEST(ConnectionLimit, LeavesDescriptorsForTheServerItself) {
  rlimit limit{};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &limit), 0);
  const int most = RaiseConnectionLimit();
  EXPECT_GT(most, 0);
  EXPECT_LE(most, limits::kMaxConnections);
  EXPECT_LT(static_cast<rlim_t>(most), limit.rlim_max);
  rlimit after{};
  getrlimit(RLIMIT_NOFILE, &after);
  EXPECT_EQ(after.rlim_cur, limit.rlim_max);
}

}  // namespace
}  // namespace patchmill
