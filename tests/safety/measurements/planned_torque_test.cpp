// Tests the torque of the planned acceleration, and its effect on a stall.

#include "safety/measurements/planned_torque.h"

#include "safety/monitor_fixture.h"

namespace robot_control::tests {

DriveTrain heavy() {
  DriveTrain robot = two_wheels();
  robot.yaw_inertia = 10;
  return robot;
}

struct PlannedTorqueTest : MonitorTest {
  PlannedTorqueTest() {
    SafetyParameters chosen = without_heartbeat();
    chosen.yaw_rate.reaction = chosen.torque_oscillation.reaction = Reaction::kOff;
    drive_with(chosen, heavy());
  }

  /// Drives a curve around the left wheel, which stands and holds `torque`, N·m, for `cycles`. The right one gets
  /// faster by `acceleration` rad/s².
  void curve(double torque, double acceleration, int cycles) {
    turn_wheels(0);
    for (int k = 0; k < cycles; ++k) {
      speed_[1] = acceleration * k * kPeriod;
      command_.joints[0].velocity = 0.1;
      command_.joints[1].velocity = speed_[1];
      sensors_.joints[0].effort = torque;
      step();
    }
  }
};

// v̇ = r·α/2, ω̇ = r·α/b: of 12 kg, 10 kg·m², r = 0.1 m, b = 0.5 m, J = 0.005 kg·m² at 30 rad/s².
TEST_F(PlannedTorqueTest, IsThatOfABodyOnItsWheels) {
  WheelTargets targets(kWheels);
  PlannedTorque planned(heavy());
  for (const double speed : {1.0, 1.03}) {
    command_.joints[0] = {.mode = JointMode::kEffort, .velocity = 0.1};
    command_.joints[1] = {.mode = JointMode::kEffort, .velocity = speed};
    sensors_.gate.verdict = GateVerdict::kPassed;
    targets.step(input_);
    planned.step(targets, kPeriod);
  }
  const double force = 0.5 * 12 * 1.5;
  const double pair = 10 * 6 / 0.5;
  EXPECT_NEAR(planned[0], 0.1 * (force - pair), 1e-9);
  EXPECT_NEAR(planned[1], 0.1 * (force + pair) + 0.005 * 30, 1e-9);
  planned.enter_run();
  planned.step(targets, kPeriod);
  EXPECT_EQ(planned[1], 0) << "no step before";
}

// 0.1·(0.3 − 4.0) N·m·s²/rad of the left wheel, at 5 rad/s² of the right one: more than half of its limit of 3 N·m.
TEST_F(PlannedTorqueTest, AWheelThatHoldsItsSideInACurveIsNotStalled) {
  curve(-1.85, 5, 400);
  EXPECT_EQ(permit_.causes, 0u);
}

TEST_F(PlannedTorqueTest, AWheelThatPushesWithoutAnAccelerationIs) {
  curve(-1.85, 0, 400);
  EXPECT_EQ(permit_.causes, std::uint64_t{kCauseStall});
}

TEST_F(PlannedTorqueTest, AWheelThatPushesByMoreThanItsAccelerationTakesIs) {
  curve(1.85, 5, 400);
  EXPECT_EQ(permit_.causes, std::uint64_t{kCauseStall});
}

}  // namespace robot_control::tests
