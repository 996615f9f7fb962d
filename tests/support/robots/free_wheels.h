#pragma once
/// A differential drive without simulated physics, for measurements of the loop alone. Its wheels turn freely under
/// the torques of their drives:
///
///   J q̈ = τ,   J = wheel inertia + m r²/n,   v = mean of r q̇,   ω = difference of the sides over the wheel base
///
/// m is the mass of the robot, n the number of its wheels. The IMU measures ω and the weight. As a simulator it waits
/// when its node is late, so a busy machine does not stop it.

#include <span>
#include <vector>

#include "drivers/driver.h"
#include "drivers/joint_law.h"
#include "machine/wheeled/drive_train.h"

namespace robot_control {

class FreeWheels final : public Simulator {
 public:
  /// `brakes`: one per drive wheel; `period` is in s.
  FreeWheels(const DriveTrain& robot, std::span<const Brake> brakes, double period) : robot_(robot), period_(period) {
    for (std::size_t i = 0; i < robot_.wheels.size(); ++i) laws_.emplace_back(brakes[i], robot_.joints[i].effort_limit);
  }

  void start() override { stopped_ = false; }
  void read(SensorFrame& sensors) noexcept override {
    sensors.driver_state = DriverState::kRunning;
    sensors.valid = kValidGyro | kValidAccelerometer;
    sensors.joint_count = robot_.joints.size();
    for (std::size_t i = 0; i < wheels_.size(); ++i) sensors.joints[i] = wheels_[i];
    flicker_ = -flicker_;
    sensors.imu.angular_velocity = {flicker_, flicker_, yaw_rate() + flicker_};
    sensors.imu.linear_acceleration = {flicker_, flicker_, 9.81 + flicker_};
  }
  void write(std::span<const JointCommand> commands) noexcept override {
    for (std::size_t i = 0; i < wheels_.size(); ++i) {
      JointSample& wheel = wheels_[i];
      wheel.effort = laws_[i].step(stopped_ ? JointCommand{} : commands[i], wheel.position, wheel.velocity);
      wheel.velocity += wheel.effort / inertia(i) * period_;
      wheel.position += wheel.velocity * period_;
    }
  }
  void stop() noexcept override { stopped_ = true; }
  void truth(TruthFrame&) noexcept override {}
  void inject(const InjectedFaults&) noexcept override {}
  bool accepts(JointMode mode) const noexcept override { return JointLaw::computes(mode); }
  bool measures(MachineInput input) const noexcept override { return input != MachineInput::kContacts; }

 private:
  double inertia(std::size_t i) const noexcept {
    const WheelModel& wheel = robot_.wheels[i];
    return wheel.inertia + robot_.mass * wheel.radius * wheel.radius / static_cast<double>(wheels_.size());
  }
  double yaw_rate() const noexcept {
    double turn = 0;
    for (std::size_t i = 0; i < wheels_.size(); ++i) {
      const WheelModel& wheel = robot_.wheels[i];
      turn += (wheel.side == Side::kRight ? 1 : -1) * wheel.sign * wheel.radius * wheels_[i].velocity;
    }
    return 2 * turn / (static_cast<double>(wheels_.size()) * robot_.effective_wheel_base());
  }

  DriveTrain robot_;
  double period_;
  std::vector<JointLaw> laws_;
  std::vector<JointSample> wheels_ = std::vector<JointSample>(robot_.wheels.size(), {.valid = kValidMotion});
  double flicker_ = 1e-4;  // rad/s and m/s²; a real sensor never repeats its values
  bool stopped_ = false;
};

}  // namespace robot_control
