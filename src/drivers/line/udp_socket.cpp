#include "drivers/line/udp_socket.h"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <memory>

#include "drivers/driver.h"
#include "files/message_text.h"

namespace robot_control {
namespace {

constexpr std::uint32_t kLoopback = 0x7F000000;
constexpr std::uint32_t kLoopbackMask = 0xFF000000;

template <class Address>
sockaddr* generic(Address& address) {
  return static_cast<sockaddr*>(static_cast<void*>(&address));
}

}  // namespace

std::optional<sockaddr_in> udp_address(const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) return {};
  sockaddr_in address{};
  address.sin_family = AF_INET;
  std::uint16_t port = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data() + colon + 1, end, port);
  if (error != std::errc() || rest != end || port == 0) return {};
  if (inet_pton(AF_INET, text.substr(0, colon).c_str(), &address.sin_addr) != 1) return {};
  address.sin_port = htons(port);
  return address;
}

std::unique_ptr<UdpSocket> UdpSocket::host_end(const std::string& device, std::uint16_t port) {
  return std::unique_ptr<UdpSocket>(new UdpSocket(device, port));
}

std::unique_ptr<UdpSocket> UdpSocket::device_end(const std::string& device) {
  return std::unique_ptr<UdpSocket>(new UdpSocket(device, 0));
}

/// `port` 0: the device's end.
UdpSocket::UdpSocket(const std::string& device, std::uint16_t port)
    : name_("UDP " + printable(device)),
      answers_(port == 0),
      socket_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {
  const auto refuse = [&](const std::string& problem, const std::string& remedy) {
    throw DriverError(name_ + ": " + problem + "; " + remedy);
  };
  const std::optional<sockaddr_in> address = udp_address(device);
  if (!address) refuse("this is not an address", "set the device's one as IPV4:PORT");
  if (!socket_.open()) refuse(std::strerror(errno), "stop other programs");
  sockaddr_in own = *address;
  if (port != 0) {
    own.sin_port = htons(port);
    const bool loopback = (ntohl(address->sin_addr.s_addr) & kLoopbackMask) == kLoopback;
    if (!loopback) own.sin_addr.s_addr = htonl(INADDR_ANY);
  }
  if (bind(socket_.number(), generic(own), sizeof own) != 0) {
    const std::string place = port != 0 ? "port " + std::to_string(port) + " of this computer" : "this address";
    refuse(place + " cannot be used: " + std::strerror(errno),
           errno == EADDRINUSE ? "stop the program that uses it, or set another port"
                               : "a simulated device needs an address of this computer, as 127.0.0.1:8007");
  }
  if (port == 0) return;
  peer_ = *address;
  if (connect(socket_.number(), generic(peer_), sizeof peer_) != 0)
    refuse(std::strerror(errno), "give this computer an address in the network of the device");
}

std::size_t UdpSocket::receive(std::span<std::uint8_t> bytes) noexcept {
  for (int i = 0; i <= kMaxDropped; ++i) {
    sockaddr_in from{};
    socklen_t size = sizeof from;
    const ssize_t got = recvfrom(socket_.number(), bytes.data(), bytes.size(), MSG_TRUNC, generic(from), &size);
    if (got < 0 && errno != ECONNREFUSED) return 0;  // that error is of an earlier datagram of ours
    const bool of_peer = from.sin_port == peer_.sin_port && from.sin_addr.s_addr == peer_.sin_addr.s_addr;
    if (got <= 0 || !(answers_ || of_peer)) continue;
    peer_ = from;
    return static_cast<std::size_t>(got);
  }
  return 0;
}

void UdpSocket::wait(int timeout_ms) const noexcept {
  pollfd socket{.fd = socket_.number(), .events = POLLIN, .revents = 0};
  poll(&socket, 1, timeout_ms);
}

bool UdpSocket::send(std::span<const std::uint8_t> bytes) noexcept {
  if (peer_.sin_port == 0) return false;
  return sendto(socket_.number(), bytes.data(), bytes.size(), MSG_NOSIGNAL, generic(peer_), sizeof peer_) ==
         static_cast<ssize_t>(bytes.size());
}

}  // namespace robot_control
