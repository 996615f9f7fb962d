#include "runtime/start_check.h"

#include <gtest/gtest.h>

#include "cycle_fixture.h"

namespace robot_control {
namespace {

TEST(Identity, DiffersByRateAndClock) {
  LoopParameters loop;
  LoopParameters slower = loop;
  slower.rate = 500;
  LoopParameters lockstep = loop;
  lockstep.clock = ClockMode::kLockstep;
  const RobotModel robot = two_wheels();
  EXPECT_EQ(identified(robot, loop).hash, identified(robot, loop).hash);
  EXPECT_NE(identified(robot, loop).hash, identified(robot, slower).hash);
  EXPECT_NE(identified(robot, loop).hash, identified(robot, lockstep).hash);
  EXPECT_EQ(identified(robot, slower).source, "test at 500 Hz, clock wall");
}

TEST(StartCheck, RefusesGainsThatAreUnstableOnThisRobot) {
  Parameters parameters;
  EXPECT_NO_THROW(require_drivable(parameters, two_wheels()));
  parameters.controller.pid_kp = 20;
  EXPECT_THROW(require_drivable(parameters, two_wheels()), ParameterError);
}

}  // namespace
}  // namespace robot_control
