#pragma once
/// A DatagramDriveFile is the drive file of a device on UDP: a block of the device, and one block per joint.

#include "drivers/drive/drive_file.h"
#include "drivers/line/udp_socket.h"

namespace robot_control {

class DatagramDriveFile : public DriveFile {
 public:
  using DriveFile::DriveFile;

  LineEnd open_line(RealtimePolicy /*policy*/, const DriverClock& /*clock*/) const override {
    return UdpSocket::host_end(address(), host_port());
  }

  /// Returns the UDP port of this computer.
  virtual std::uint16_t host_port() const = 0;
};

}  // namespace robot_control
