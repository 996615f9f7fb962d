/// The gate's clamps are for faults: no shipped loop ever reaches one.

#include <gtest/gtest.h>

#include "control/wheeled/kinematics.h"
#include "gate/joint_clamp.h"
#include "simulation/closed_loop.h"

namespace robot_control::tests {

constexpr std::uint64_t kClamps = kGateEffortClamped | kGateRateClamped | kGateSpeedClamped | kGatePositionClamped;

using Request = std::function<Twist(double time)>;

Twist twist(double linear, double angular) {
  return {.linear = {linear, 0, 0}, .angular = {0, 0, angular}};
}

/// Full speed, hard reversals, spins, and stops that are long enough for the brake, with a new request every 0.7 s.
Twist restless(double time) {
  constexpr double kTable[][2] = {{1, 0},  {-1, 0}, {0, 2}, {0, -2}, {1, 2},  {-1, 2},
                                  {1, -2}, {0, 0},  {0, 0}, {0, 0},  {-1, -2}};
  const auto& now = kTable[static_cast<std::size_t>(time / 0.7) % std::size(kTable)];
  return twist(now[0], now[1]);
}

struct GateInTheLoop : testing::Test {
  GateInTheLoop() : parameters_(read_parameters(PROJECT_DIRECTORY "/config/robot_params.yaml")) {}

  void expect_no_clamp(const Request& request, double seconds) {
    ClosedLoop loop(parameters_);
    std::uint64_t passed = 0;
    while (loop.time() < seconds) {
      loop.command(request(loop.time()));
      loop.step();
      const GateReport& gate = loop.row().driver->gate;
      ASSERT_EQ(gate.reasons & kClamps, 0u) << "at " << loop.time() << " s, " << parameters_.loop.rate << " Hz";
      passed += gate.verdict == GateVerdict::kPassed;
    }
    EXPECT_GT(static_cast<double>(passed) / parameters_.loop.rate, seconds / 2);  // else it did not drive
  }

  Parameters parameters_;
};

TEST_F(GateInTheLoop, NeverClampsAtAnyRate) {
  for (const double rate : {100.0, 250.0, 500.0, 1000.0, 2000.0}) {
    parameters_.loop.rate = rate;
    expect_no_clamp(restless, 16);
  }
}

// The controller begins with the torque that the brake held, without a step from zero.
TEST_F(GateInTheLoop, NeverClampsWhereTheBrakeLetsGoOnASlope) {
  parameters_.plant.slope = 0.0873;  // 5°
  expect_no_clamp(restless, 16);
}

// 10 rad/s of 14. One cycle's difference of 64 counts a turn is 98 rad/s, that of the gate's window 8.
TEST_F(GateInTheLoop, DoesNotTakeACoarseEncoderForATooFastWheel) {
  parameters_.plant.encoder_resolution = 64;
  parameters_.robot.wheel_velocity_limit = 14;
  parameters_.robot.wheel_effort_rate = 1e9;  // the tracking loop of the controller does take it for an acceleration
  expect_no_clamp([](double) { return twist(1, 0); }, 5);
}

// At the wheels' speed limit the gate would take away the torque that the load uphill needs.
TEST_F(GateInTheLoop, IsNotTaperingAtTheSpeedLimitOfTheController) {
  static_assert(kUsableWheelSpeed == kTaperStart);
  parameters_.plant.slope = 0.0873;
  parameters_.robot.wheel_velocity_limit = 8;
  ClosedLoop loop(parameters_);
  const auto drive = [&](double request, double until) {
    while (loop.time() < until) {
      loop.command(twist(request, 0));
      loop.step();
    }
    return loop.row().driver->truth.twist_base.linear[0];
  };
  EXPECT_NEAR(drive(1, 4), 0.9 * 0.8, 0.002);
  EXPECT_EQ(loop.row().driver->gate.reasons & kGateSpeedClamped, 0u);
  EXPECT_NE(loop.row().controller->command.reasons & kReasonSaturated, 0u);
  const double limited = drive(0, 4.2);
  EXPECT_NEAR(limited, loop.row().controller->command.twist_limited.linear[0], 0.02);
}

}  // namespace robot_control::tests
