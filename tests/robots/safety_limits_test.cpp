#include "robots/wheeled/safety_limits.h"

#include <gtest/gtest.h>

#include "control/wheeled/wheel_loops/wheel_loop_gains.h"
#include "loop/cycle_fixture.h"
#include "safety/derived_limits.h"

namespace robot_control::tests {

constexpr double kRounding = 1e-12;

DriveControllerParameters limits(double linear, double angular) {
  DriveControllerParameters parameters;
  parameters.max_linear_speed = linear;
  parameters.max_angular_speed = angular;
  return parameters;
}

// (1 + 2·0.5/2)/0.1 = 15 rad/s
TEST(CommandedWheelSpeed, IsTheOuterWheelsAtBothLimits) {
  EXPECT_NEAR(commanded_wheel_speed(limits(1, 2), two_wheels()), 15, kRounding);
}

TEST(CommandedWheelSpeed, IsTheSmallestWheels) {
  DriveTrain robot = two_wheels();
  robot.wheels[1].radius = 0.0875;
  EXPECT_NEAR(commanded_wheel_speed(limits(1, 2), robot), 1.5 / 0.0875, kRounding);
}

TEST(CommandedWheelSpeed, IsNoFasterThanTheSlowestWheelCan) {
  DriveTrain robot = two_wheels();
  robot.joints[1].velocity_limit = 9;
  EXPECT_EQ(commanded_wheel_speed(limits(1, 2), robot), 9);
}

TEST(SafetyLimits, KeepWhatIsGivenAndDeriveTheRest) {
  Parameters parameters;
  parameters.safety.power.limit = 7;
  const SafetyParameters filled = safety_limits(parameters, two_wheels());
  EXPECT_EQ(filled.power.limit, 7);
  ASSERT_TRUE(filled.wheel_speed.limit.has_value());
  EXPECT_GT(*filled.wheel_speed.limit, commanded_wheel_speed(parameters.controller, two_wheels()));
}

// 20 Hz, and the gain of control/wheeled/wheel_loops/wheel_loop_gains.h: 0.5·2·2π·20 Hz per N·m·s/rad.
TEST(SafetyLimits, KnowWhatTheDerivedGainsMakeOfACount) {
  const DriveTrain robot = two_wheels();
  const double kp = wheel_loop_gains(DriveControllerParameters{}, robot, robot.wheels[0], 1e-3).kp;
  Parameters parameters;
  parameters.controller.pid_kp = 0.1;
  const SafetyParameters filled = safety_limits(parameters, robot);
  EXPECT_NEAR(filled.count_ripple[0], 62.83 * kp, 0.01) << "whatever the user has set";
  EXPECT_EQ(filled.count_ripple[1], filled.count_ripple[0]);
  EXPECT_EQ(filled.count_ripple[2], 0);
}

DriverName driver_named(std::string_view word) {
  const std::vector<Word> words = words_of(DriverName());
  return static_cast<DriverName>(std::ranges::find(words, word, &Word::text)->value);
}

TEST(SafetyLimits, ASerialBoardMayBeSilentForTwelveCyclesAndNoLongerThanItsWatchdog) {
  Parameters parameters;
  for (const auto& [rate, silence] : {std::pair{1000.0, 0.012}, std::pair{250.0, 0.048}, std::pair{20.0, 0.05}}) {
    parameters.loop.rate = rate;
    parameters.driver = driver_named("can");
    EXPECT_EQ(safety_limits(parameters, two_wheels()).encoders_lost.persistence, 0.01);
    parameters.driver = driver_named("board");
    EXPECT_NEAR(safety_limits(parameters, two_wheels()).encoders_lost.persistence, silence, 1.0e-12) << rate;
  }
  parameters.safety.encoders_lost.persistence = 0.1;
  EXPECT_EQ(safety_limits(parameters, two_wheels()).encoders_lost.persistence, 0.1) << "a longer one stays";
}

}  // namespace robot_control::tests
