#pragma once
/// The drive file of a Unitree Go1: a block of the robot's low level, and one block per joint.

#include "drivers/drive/datagram_drive_file.h"
#include "drivers/unitree_legged/go1.h"

namespace robot_control {

class UnitreeLeggedFile final : public FileOfJoints<DatagramDriveFile, UnitreeLeggedJoint> {
 public:
  using FileOfJoints::FileOfJoints;

  std::string_view line_block() const override { return "unitree_legged"; }
  Keys line_keys() override { return keys(line_); }
  void check_line(GivenValues& given) const override;
  double tolerated_silence() const override { return kLeggedSilence; }
  const std::string& address() const override { return line_.address; }
  std::uint16_t host_port() const override { return static_cast<std::uint16_t>(line_.port); }
  std::unique_ptr<Driver> make_driver(const DriveMotors& motors, LineEnd end, DriverClock clock) const override;

  UnitreeLeggedParameters parameters() const { return {line_, joints()}; }

 private:
  UnitreeLeggedLine line_;
};

}  // namespace robot_control
