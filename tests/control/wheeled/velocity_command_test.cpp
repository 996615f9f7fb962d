/// The drives close the wheel loops: the controller sends speeds, reads no torque, and waits for wheels that lag.

#include <gtest/gtest.h>

#include <cmath>

#include "control/wheeled/control_bench.h"
#include "control/wheeled/control_problems.h"

namespace robot_control::tests {

constexpr double kWheelRadius = 0.1;  // m
constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

/// Wheels that take speeds: each follows its command with a time constant, no faster than an acceleration.
class VelocityBench {
 public:
  static constexpr double kPeriod = 1e-3;

  explicit VelocityBench(double response, double acceleration = 1e9, const DriveTrain& machine = robot(),
                         std::uint32_t takes = kTakesEffort)
      : response_(response), acceleration_(acceleration), controller(parameters(), machine, kPeriod) {
    controller.enter_run();
    permit_.action = PermitAction::kDrive;
    permit_.speed_limit = kNoSpeedLimit;
    state_.base.flags = kStateValid;
    sensors_.joint_count = robot().joints.size();
    for (JointSample& joint : sensors_.joints) joint = {.effort = kNotMeasured, .valid = kValidKinematics | takes};
  }

  void send(double linear, double angular) {
    request_.content.twist = {.linear = {linear, 0, 0}, .angular = {0, 0, angular}};
    ++request_.count;
  }

  void step() {
    sensors_.head.cycle = state_.head.cycle = permit_.head.cycle = cycle_++;
    const CommandFrame last = command;
    controller.step({&sensors_, &state_, &permit_, request_}, command);
    sensors_.gate.verdict =
        last.joints[0].mode == JointMode::kDriveVelocity ? GateVerdict::kPassed : GateVerdict::kBrake;
    for (std::size_t i = 0; i < 2; ++i) {
      JointSample& joint = sensors_.joints[i];
      const double target = last.joints[i].mode == JointMode::kDriveVelocity ? last.joints[i].velocity : 0;
      const double rate = (target - joint.velocity) / response_;
      joint.velocity += std::clamp(rate, -acceleration_, acceleration_) * kPeriod;
      joint.position += joint.velocity * kPeriod;
    }
  }

  void run(double seconds) {
    for (double t = 0; t < seconds; t += kPeriod) step();
  }

  static DriveTrain robot() {
    DriveTrain robot = make_test_robot();
    robot.wheel_command = WheelCommand::kVelocity;
    robot.wheel_response_time = 0.02;
    return robot;
  }

  double speed(std::size_t wheel) const { return sensors_.joints[wheel].velocity; }

 private:
  static DriveControllerParameters parameters() {
    DriveControllerParameters patient;
    patient.cmd_vel_timeout = 0;
    return patient;
  }

  double response_, acceleration_;
  SensorFrame sensors_;
  StateFrame state_;
  Permit permit_;
  VelocityCommand request_;
  std::uint64_t cycle_ = 0;

 public:
  DriveController controller;
  CommandFrame command;
};

TEST(VelocityCommand, IsThePlannedSpeedOfEachWheelWithoutAnyTorqueMeasured) {
  VelocityBench bench(0.02);
  bench.run(0.3);
  bench.send(0.5, 0);
  bench.run(3);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(bench.command.joints[i].mode, JointMode::kDriveVelocity);
    EXPECT_NEAR(bench.command.joints[i].velocity, 0.5 / kWheelRadius, 1e-9);
    EXPECT_TRUE(std::isfinite(bench.command.joints[i].effort));
    EXPECT_NEAR(bench.speed(i), 0.5 / kWheelRadius, 1e-3);
  }
  EXPECT_EQ(bench.command.reasons & kReasonBadSensors, 0u);
}

TEST(VelocityCommand, IsNotStretchedForADriveThatIsTwiceAsSlowAsStated) {
  VelocityBench bench(0.04);
  bench.run(0.3);
  bench.send(0.5, 0);
  for (int i = 0; i < 3000; ++i) {
    bench.step();
    ASSERT_EQ(bench.command.reasons & kReasonSaturated, 0u) << i << " ms";
  }
}

TEST(VelocityCommand, WaitsForWheelsThatCannotAccelerateAsPlanned) {
  VelocityBench bench(0.02, 4);  // rad/s²; the plan has 10
  bench.run(0.3);
  bench.send(0.8, 0);
  double lag = 0;
  bool saturated = false;
  for (int i = 0; i < 3000; ++i) {
    bench.step();
    lag = std::max(lag, bench.command.joints[0].velocity - bench.speed(0));
    saturated = saturated || (bench.command.reasons & kReasonSaturated) != 0;
  }
  EXPECT_TRUE(saturated);
  EXPECT_LT(lag, 1.5) << "rad/s; without waiting it reaches 4.8";
  EXPECT_NEAR(bench.speed(0), 8, 1e-2);
}

TEST(VelocityCommand, LeadsAStopToItsEndBeforeTheWheelsAreHeld) {
  DriveTrain slower = VelocityBench::robot();
  slower.wheel_response_time = 0.1;
  VelocityBench bench(0.02, 1e9, slower, 0);
  bench.run(0.3);
  bench.send(0.1, 0);
  bench.run(3);
  bench.send(0, 0);
  double ordered = 0, planned = 0;
  for (int i = 0; i < 4000; ++i) {
    bench.step();
    ordered += bench.command.joints[0].velocity * VelocityBench::kPeriod;
    planned += bench.command.twist_limited.linear[0] / kWheelRadius * VelocityBench::kPeriod;
  }
  EXPECT_NEAR(ordered, planned, 1e-3) << "rad; held before, the way is shorter by what the lead would still drive";
  EXPECT_EQ(bench.command.joints[0].mode, JointMode::kBrake);
}

TEST(VelocityCommand, RefusesGainsOfLoopsThatTheDrivesClose) {
  DriveControllerParameters parameters;
  EXPECT_TRUE(control_problems(parameters, VelocityBench::robot(), 1e-3).empty());
  parameters.pid_kp = 2;
  parameters.pid_ki = 20;
  EXPECT_EQ(control_problems(parameters, VelocityBench::robot(), 1e-3).size(), 2u);
}

}  // namespace robot_control::tests
