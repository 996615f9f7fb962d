#pragma once
/// Two wheels in the air behind the simulated drives of an example of config/drives.

#include <gtest/gtest.h>

#include "drivers/table/drive_table.h"
#include "drivers/table/read_drive_file.h"
#include "drivers/table/simulated_front.h"
#include "drivers/wheels_in_air.h"

namespace robot_control {

class DriveMachine final : public WheelsInAir<DeviceFront, Driver> {
 public:
  static constexpr double kRate = 500;  // Hz, which every line carries

  DriveMachine(const DriveRow& row, bool takes_speeds) : WheelsInAir(1 / kRate) {
    const std::string path = PROJECT_DIRECTORY "/config/drives/" + std::string(row.name) + ".yaml";
    file_ = read_drive_file(path, row.driver, {.joints = motors_.joints, .rate = kRate, .takes_speeds = takes_speeds});
    board_ = make_front(*file_, {.motors = motors_});
    driver_ = file_->make_driver(motors_, board_->driver_end(),
                                 [this] { return CanTime{.time_ns = board_->now_ns(), .utc_ns = board_->now_ns()}; });
  }

  void start() override { WheelsInAir::start(static_cast<int>(5 * kRate)); }

  const DriveFile& file() const { return *file_; }

 private:
  DriveMotors motors_{.joints = {"left_wheel_joint", "right_wheel_joint"},
                      .effort_limits = {kEffortLimit, kEffortLimit},
                      .brakes = {kBrake, kBrake},
                      .joint_count = 2};
  std::unique_ptr<DriveFile> file_;
};

}  // namespace robot_control
