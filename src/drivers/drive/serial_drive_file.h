#pragma once
/// A SerialDriveFile is the drive file of a board on a serial line: a block of the board, and one block per joint.

#include <utility>

#include "drivers/drive/drive_file.h"
#include "drivers/line/serial_port.h"

namespace robot_control {

/// `Line` holds the members of the board's block, among them address and bit_rate.
template <class Line>
class SerialDriveFile : public DriveFile {
 public:
  using DriveFile::DriveFile;

  Keys line_keys() override { return keys(line); }
  void check_line(GivenValues& given) const override {
    const std::string path = std::string(line_block()) + ".bit_rate";
    if (given.accepted(path) && line.bit_rate != 0 && !is_bit_rate(static_cast<unsigned>(line.bit_rate)))
      given.refuse(path, "is not a bit rate of a tty", "set 115200, 460800, 921600 …, or 0 for USB");
  }
  const std::string& address() const override { return line.address; }
  LineEnd open_line(RealtimePolicy policy, const DriverClock& clock) const override {
    constexpr int kPriority = 84;  // above the loop: the thread only takes bytes, at the time of their arrival
    const RealtimeParameters thread{.name = "serial", .policy = policy, .priority = kPriority, .core = -1};
    return std::make_unique<SerialPort>(line.address, static_cast<unsigned>(line.bit_rate), thread,
                                        [clock] { return clock().time_ns; });
  }

  Line line;

 protected:
  /// Returns the time in ns.
  static std::function<std::int64_t()> time_of(DriverClock clock) {
    return [clock = std::move(clock)] { return clock().time_ns; };
  }
};

}  // namespace robot_control
