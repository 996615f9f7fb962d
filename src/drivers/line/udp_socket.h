#pragma once
/// A UdpSocket is a DatagramLine over UDP of IPv4. All system calls of `receive` and `send` are non-blocking.
///
/// The host's end takes datagrams of the device's address alone. With a device on the loopback it is bound to the
/// loopback. The device's end, of a simulated device, is bound to the device's address and answers the last sender. One
/// call of `receive` drops up to kMaxDropped others and empty ones.

#include <netinet/in.h>

#include <memory>
#include <optional>

#include "drivers/line/datagram_line.h"
#include "files/descriptor.h"

namespace robot_control {

/// Returns the address of a text like 192.168.123.10:8007; none for any other text.
std::optional<sockaddr_in> udp_address(const std::string& text);

class UdpSocket final : public DatagramLine {
 public:
  static constexpr int kMaxDropped = 16;

  /// `device` is its address (udp_address), `port` that of the host. Throws DriverError.
  static std::unique_ptr<UdpSocket> host_end(const std::string& device, std::uint16_t port);
  static std::unique_ptr<UdpSocket> device_end(const std::string& device);

  std::size_t receive(std::span<std::uint8_t> bytes) noexcept override;
  bool send(std::span<const std::uint8_t> bytes) noexcept override;
  std::string name() const override { return name_; }

  /// Waits until a datagram is there, for a thread outside of the loop.
  void wait(int timeout_ms) const noexcept;

 private:
  UdpSocket(const std::string& device, std::uint16_t port);

  std::string name_;
  bool answers_;  // the device's end
  Descriptor socket_;
  sockaddr_in peer_{};  // port 0: none yet
};

}  // namespace robot_control
