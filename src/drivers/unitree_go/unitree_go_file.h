#pragma once
/// The drive file of a Unitree Go2 or B2: a block of the robot's low level with unitree_bridge, and one block per
/// joint.

#include "drivers/drive/datagram_drive_file.h"
#include "drivers/unitree_go/go2.h"

namespace robot_control {

class UnitreeGoFile final : public FileOfJoints<DatagramDriveFile, UnitreeJoint<Go2>> {
 public:
  using FileOfJoints::FileOfJoints;

  std::string_view line_block() const override { return "unitree_go"; }
  Keys line_keys() override { return keys(line_); }
  void check_line(GivenValues& given) const override;
  double tolerated_silence() const override { return kGoSilence; }
  const std::string& address() const override { return line_.address; }
  std::uint16_t host_port() const override { return static_cast<std::uint16_t>(line_.port); }
  std::unique_ptr<Driver> make_driver(const DriveMotors& motors, LineEnd end, DriverClock clock) const override;

  const UnitreeGoLine& line() const noexcept { return line_; }
  UnitreeParameters<Go2> parameters() const { return {line_, joints()}; }

 private:
  UnitreeGoLine line_;
};

}  // namespace robot_control
