// A motor's torque oscillates without need; other torques only look like it.

#include "safety/monitor_fixture.h"

namespace robot_control::tests {

/// It drives at 5 rad/s with motors of 3 N·m; the limit is 0.3 of that for 1 s. A wheel drives 0.065 kg·m².
struct TorqueOscillationTest : MonitorTest {
  static constexpr double kLimit = 3;  // N·m
  static constexpr double kInertia = 0.065;

  TorqueOscillationTest() { begin(0); }

  /// Begins with this torque per rad of a count.
  void begin(double count_ripple) {
    SafetyParameters chosen = parameters();
    chosen.heartbeat_timeout = 0;
    chosen.torque_oscillation = {.limit = 0.3, .persistence = 1.0, .reaction = Reaction::kBrake};
    chosen.wheel_effort.reaction = chosen.power.reaction = Reaction::kOff;
    chosen.count_ripple.fill(count_ripple);
    drive_with(chosen, robot());
  }

  void pull(std::size_t wheel, double effort) {
    sensors_.joints[wheel].effort = command_.joints[wheel].effort = effort;
  }

  /// Alternates between ±`amplitude` N·m, at 62.5 Hz.
  void alternate(double amplitude, double seconds) {
    const auto cycles = static_cast<std::uint64_t>(seconds / kPeriod);
    for (std::uint64_t k = 0; k < cycles && permit_.causes == 0; ++k) {
      pull(1, k / 8 % 2 == 0 ? amplitude : -amplitude);
      step();
      if (first_warning_ == 0 && permit_.warnings != 0) first_warning_ = k;
    }
  }

  std::uint64_t first_warning_ = 0;  ///< cycles after the onset
};

TEST_F(TorqueOscillationTest, IsWarnedOfAndThenStopsTheRobot) {
  const std::uint64_t onset = cycle();
  alternate(kLimit, 2);
  EXPECT_EQ(permit_.causes, std::uint64_t{kCauseTorqueOscillation});
  EXPECT_EQ(permit_.action, PermitAction::kBrake);
  EXPECT_EQ(permit_.evidence[0].joint, 1u);
  EXPECT_GT(permit_.evidence[0].value, 0.8) << "of the limit";
  EXPECT_NEAR(static_cast<double>(cycle() - onset), 1000 + 50, 30) << "its persistence, and 0.3 of a mean over 0.5 s";
  EXPECT_NEAR(static_cast<double>(first_warning_), 500 + 50, 30);
}

TEST_F(TorqueOscillationTest, IsNoneBelowItsLimitOrForAMoment) {
  alternate(0.29 * kLimit, 10);
  EXPECT_EQ(permit_.causes | permit_.warnings, 0u);
  for (int k = 0; k < 10; ++k) {
    alternate(kLimit, 0.1);
    pull(1, 0);
    steps(1500);
  }
  EXPECT_EQ(permit_.causes | permit_.warnings, 0u);
}

// The target goes to and fro at 5 Hz by ±46 rad/s², which takes all the torque there is.
TEST_F(TorqueOscillationTest, IsNoneWhereThePlannedMotionAsksForIt) {
  double wanted = kSpeed;
  for (int k = 0; k < 5000; ++k) {
    const double torque = k / 100 % 2 == 0 ? kLimit : -kLimit;
    wanted += torque / kInertia * kPeriod;
    target(wanted);
    turn_wheels(wanted);
    pull(0, torque);
    pull(1, torque);
    step();
    ASSERT_EQ((permit_.causes | permit_.warnings) & kCauseTorqueOscillation, 0u) << k;
  }
}

// Derived gains make 1000 N·m/rad from 4096 counts: 1.5 N·m. Half of the limit and 0.3 of it are allowed.
TEST_F(TorqueOscillationTest, IsNoneWhereTheEncodersCountsMakeIt) {
  begin(1000);
  alternate(0.8 * kLimit, 10);
  EXPECT_EQ(permit_.causes | permit_.warnings, 0u);
  alternate(kLimit, 3);
  EXPECT_EQ(permit_.causes, std::uint64_t{kCauseTorqueOscillation});
}

// Near its speed limit the gate takes the torque away whenever a count says that the wheel is too fast.
TEST_F(TorqueOscillationTest, IsNoneThatTheGateMakesOfASteadyCommand) {
  for (std::uint64_t k = 0; k < 5000; ++k) {
    pull(1, kLimit);
    sensors_.joints[1].effort = k / 4 % 2 == 0 ? kLimit : 0;
    step();
  }
  EXPECT_EQ(permit_.causes | permit_.warnings, 0u);
}

}  // namespace robot_control::tests
