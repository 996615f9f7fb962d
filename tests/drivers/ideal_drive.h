#pragma once
/// A wheel in the air on an ideal motor drive; each command turns it for one period.

#include <cmath>
#include <memory>
#include <vector>

#include "drivers/example_driver.h"
#include "support/diffbot_urdf.h"

namespace robot_control {

class IdealDrive final : public DriveLink {
 public:
  static constexpr double kInertia = 0.01;  ///< kg·m²
  static constexpr double kPeriod = 0.001;  ///< s

  bool receive(DriveStatus& status) noexcept override {
    status = {.joint = joint};
    return !silent;
  }
  void send_torque(double torque) noexcept override {
    holding_ = false;
    turn(torque);
  }
  void send_brake() noexcept override {
    if (!holding_ && std::abs(joint.velocity) < kHoldSpeed) {
      holding_ = true;
      held_ = joint.position;
    }
    turn((holding_ ? kStiffness * (held_ - joint.position) : 0) - kDamping * joint.velocity);
  }

  JointSample joint;
  bool silent = false;

 private:
  static constexpr double kHoldSpeed = 0.3;  ///< rad/s
  static constexpr double kStiffness = 20;   ///< N·m/rad
  static constexpr double kDamping = 1;      ///< N·m·s/rad

  void turn(double torque) noexcept {
    joint.effort = torque;
    joint.velocity += torque / kInertia * kPeriod;
    joint.position += joint.velocity * kPeriod;
  }

  bool holding_ = false;
  double held_ = 0;
};

/// diffbot's two wheels, and the drives that a test can spoil.
struct ExampleMachine {
  std::vector<IdealDrive*> drives;
  std::unique_ptr<Driver> driver;
};

inline ExampleMachine example_machine() {
  ExampleMachine machine;
  std::vector<std::unique_ptr<DriveLink>> links;
  for (int i = 0; i < 2; ++i) {
    auto drive = std::make_unique<IdealDrive>();
    machine.drives.push_back(drive.get());
    links.push_back(std::move(drive));
  }
  machine.driver = std::make_unique<ExampleDriver>(read_drive_train(diffbot_urdf(), {}), std::move(links),
                                                   static_cast<std::int64_t>(IdealDrive::kPeriod * 1e9));
  return machine;
}

}  // namespace robot_control
