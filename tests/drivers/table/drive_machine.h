#pragma once
/// The joints of a drive file in the air, behind its simulated drives.

#include <gtest/gtest.h>

#include <fstream>

#include "drivers/drive/can_drive_file.h"
#include "drivers/table/drive_table.h"
#include "drivers/table/read_drive_file.h"
#include "drivers/table/simulated_front.h"
#include "drivers/wheels_in_air.h"

namespace robot_control {

inline std::string example(std::string_view drive) {
  return PROJECT_DIRECTORY "/config/drives/" + std::string(drive) + ".yaml";
}

/// Returns the joints of a drive file: its blocks without that of the line and `every_joint`.
inline std::vector<std::string> joints_of(const std::string& path) {
  std::vector<std::string> joints;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    const std::string name = line.substr(0, line.find(':'));
    if (name.ends_with("_joint") && name != "every_joint" && name.find_first_of(" #") == std::string::npos)
      joints.push_back(name);
  }
  return joints;
}

class DriveMachine final : public WheelsInAir<DeviceFront, Driver> {
 public:
  static constexpr double kRate = 500;  // Hz, which every line carries

  DriveMachine(const std::string& path, std::string_view driver, bool takes_speeds)
      : WheelsInAir(1 / kRate, joints_of(path).size()) {
    motors_ = {.joints = joints_of(path),
               .effort_limits = std::vector(joints.size(), kEffortLimit),
               .brakes = std::vector(joints.size(), kBrake),
               .joint_count = joints.size()};
    file_ = read_drive_file(path, driver, {.joints = motors_.joints, .rate = kRate, .takes_speeds = takes_speeds});
    board_ = make_front(*file_, {.motors = motors_});
    driver_ = file_->make_driver(motors_, board_->driver_end(),
                                 [this] { return CanTime{.time_ns = board_->now_ns(), .utc_ns = board_->now_ns()}; });
    turn_to_start();
  }
  /// The joints of the example.
  DriveMachine(const DriveRow& row, bool takes_speeds) : DriveMachine(example(row.name), row.driver, takes_speeds) {}

  void start() override { WheelsInAir::start(static_cast<int>(5 * kRate)); }

  const DriveFile& file() const { return *file_; }

  /// Turns the joints to the angles at which the drive file expects them at a start or a reset.
  void turn_to_start() {
    for (std::size_t i = 0; i < joints.size(); ++i)
      joints[i].position = file_->start_angle(i).value_or(joints[i].position);
  }

 private:
  DriveMotors motors_;
  std::unique_ptr<DriveFile> file_;
};

}  // namespace robot_control
