#include "ros/network/loopback.h"

#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <cstring>
#include <string_view>

namespace robot_control {
namespace {

std::atomic<bool> asked{false};

template <class Address>
Address copy_of(const sockaddr* from) {
  Address address{};
  std::memcpy(&address, from, sizeof(address));
  return address;
}

template <class Address>
int bind_now(int socket, const Address* address, socklen_t length) {
  return static_cast<int>(syscall(SYS_bind, socket, address, length));
}

}  // namespace

bool listens_on_the_loopback_alone() {
  const char* text = std::getenv("ROS_HOSTNAME");
  if (text == nullptr || *text == '\0') text = std::getenv("ROS_IP");
  const std::string_view host = text == nullptr ? "" : text;
  return host == "localhost" || host == "::1" || host.starts_with("127.");
}

void bind_as_ros_is_configured() {
  asked.store(true);
}

}  // namespace robot_control

extern "C" int bind(int socket, const sockaddr* address, socklen_t length) noexcept {
  using namespace robot_control;
  const bool narrow = asked.load() && listens_on_the_loopback_alone();
  if (narrow && address->sa_family == AF_INET && length >= sizeof(sockaddr_in)) {
    auto narrowed = copy_of<sockaddr_in>(address);
    if (narrowed.sin_addr.s_addr == htonl(INADDR_ANY)) narrowed.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return bind_now(socket, &narrowed, length);
  }
  if (narrow && address->sa_family == AF_INET6 && length >= sizeof(sockaddr_in6)) {
    auto narrowed = copy_of<sockaddr_in6>(address);
    if (IN6_IS_ADDR_UNSPECIFIED(&narrowed.sin6_addr)) narrowed.sin6_addr = in6addr_loopback;
    return bind_now(socket, &narrowed, length);
  }
  return bind_now(socket, address, length);
}
