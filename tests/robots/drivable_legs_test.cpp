/// A robot on legs that cannot stand is refused.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "robots/quadruped_fixture.h"

namespace robot_control {
namespace {

TEST(Quadruped, OfLegsThatDoNotReachTheGroundIsRefused) {
  LegModel robot = legged_robot("quadbot");
  robot.legs[0].foot_radius = -10;
  try {
    Quadruped(QuadrupedLoop::parameters(0, ErrorLevel::kIdeal), robot).require_drivable();
    FAIL();
  } catch (const ParameterError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("does not reach the ground while the robot stands 0.2"));
  }
}

}  // namespace
}  // namespace robot_control
