#include "ros/network/accepted_sockets.h"

#include <linux/tcp.h>
#include <netinet/in.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <mutex>
#include <vector>

#include "rt/clock.h"
#include "rt/futex.h"

namespace robot_control {
namespace {

constexpr std::int64_t kExhaustedPause =
    10'000'000;  // ns; without it roscpp would call accept again at once and log each failure

std::atomic<std::uint64_t> evicted{0};

ino_t inode_of(int descriptor) {
  struct stat status {};
  return fstat(descriptor, &status) == 0 && S_ISSOCK(status.st_mode) ? status.st_ino : 0;
}

bool has_sent(int socket) {
  tcp_info info{};
  socklen_t length = sizeof info;
  return getsockopt(socket, IPPROTO_TCP, TCP_INFO, &info, &length) != 0 || info.tcpi_bytes_received > 0;
}

/// The list of those sockets that were added and are still open.
class OpenSockets {
 public:
  void add(int descriptor) {
    const ino_t inode = inode_of(descriptor);
    const std::lock_guard lock(mutex_);
    if (sockets_.size() >= kLook) forget_closed();
    if (inode != 0) sockets_.push_back({.descriptor = descriptor, .inode = inode, .since_ns = monotonic_ns()});
  }

  std::uint64_t count() {
    const std::lock_guard lock(mutex_);
    forget_closed();
    return sockets_.size();
  }

  /// Shuts down the socket that the header's rule selects.
  void evict_one() {
    const std::lock_guard lock(mutex_);
    forget_closed();
    if (sockets_.empty()) return;
    const auto chosen = victim();
    shutdown(chosen->descriptor, SHUT_RDWR);
    sockets_.erase(chosen);
    evicted.fetch_add(1);
  }

 private:
  static constexpr std::size_t kLook = 256;
  static constexpr std::int64_t kHandshake = 200'000'000;  // ns
  static constexpr std::ptrdiff_t kHandshakes = 16;

  struct Socket {
    int descriptor = -1;
    ino_t inode = 0;
    std::int64_t since_ns = 0;

    /// Compares the inode, because the number may belong to another file by now.
    bool is_open() const { return inode_of(descriptor) == inode; }
  };

  /// Returns the socket that the header's rule selects. The list is not empty.
  std::vector<Socket>::iterator victim() {
    const std::int64_t now_ns = monotonic_ns();
    const auto is_young = [now_ns](const Socket& socket) { return now_ns - socket.since_ns < kHandshake; };
    const auto is_silent = [](const Socket& socket) { return !has_sent(socket.descriptor); };
    const auto silent = std::ranges::find_if(sockets_, is_silent);
    const bool many_silent = std::ranges::count_if(sockets_, is_silent) > kHandshakes;
    if (silent != sockets_.end() && (many_silent || !is_young(*silent))) return silent;
    const auto young = std::ranges::find_if(sockets_, is_young);
    const bool many_young = std::distance(young, sockets_.end()) > kHandshakes;
    return many_young || young == sockets_.begin() ? young : std::prev(young);
  }

  void forget_closed() {
    std::erase_if(sockets_, [](const Socket& socket) { return !socket.is_open(); });
  }

  std::mutex mutex_;
  std::vector<Socket> sockets_;  ///< in the order of their arrival
};

OpenSockets& accepted_sockets() {
  static OpenSockets sockets;
  return sockets;
}

OpenSockets& own_sockets() {
  static OpenSockets sockets;
  return sockets;
}

std::uint64_t descriptor_limit() {
  rlimit limit{};
  return getrlimit(RLIMIT_NOFILE, &limit) == 0 ? limit.rlim_cur : RLIM_INFINITY;
}

bool reaches_into_reserve(int descriptor, std::uint64_t eighths) {
  const std::uint64_t limit = descriptor_limit();
  return static_cast<std::uint64_t>(descriptor) >= limit - reserve_of(limit) * eighths / 8;
}

/// Returns whether this process's own connections take half of all descriptors. They are counted only if the new
/// descriptor's number shows that so many are in use.
bool are_half_of_all(int descriptor) {
  const std::uint64_t half = descriptor_limit() / 2;
  return static_cast<std::uint64_t>(descriptor) >= half && own_sockets().count() >= half;
}

}  // namespace

std::uint64_t evicted_connections() noexcept {
  return evicted.load();
}

}  // namespace robot_control

extern "C" int accept(int socket, sockaddr* address, socklen_t* length) {
  using namespace robot_control;
  const auto descriptor = static_cast<int>(syscall(SYS_accept4, socket, address, length, 0));
  if (descriptor < 0) {
    const int error = errno;
    if (error == EMFILE || error == ENFILE) {
      accepted_sockets().evict_one();
      sleep_ns(kExhaustedPause);
    }
    errno = error;
    return descriptor;
  }
  if (reaches_into_reserve(descriptor, 8)) accepted_sockets().evict_one();
  accepted_sockets().add(descriptor);
  return descriptor;
}

extern "C" int socket(int domain, int type, int protocol) noexcept {
  using namespace robot_control;
  const auto descriptor = static_cast<int>(syscall(SYS_socket, domain, type, protocol));
  const bool internet = domain == AF_INET || domain == AF_INET6;
  if (descriptor < 0 || !internet) return descriptor;
  if (!reaches_into_reserve(descriptor, 6) && !are_half_of_all(descriptor)) {
    own_sockets().add(descriptor);
    return descriptor;
  }
  close(descriptor);
  errno = EMFILE;
  return -1;
}
