#include "control/legged/body_bounds.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "machine/gravity.h"
#include "robots/quadruped_fixture.h"

namespace robot_control {
namespace {

class BodyBoundsOf : public testing::TestWithParam<std::string> {};

/// A body that is a point on the ground amid the feet would reach μ g ahead and sideways, and g upwards. Half of it is
/// allowed. Height, and legs that move with the body, take some more.
TEST_P(BodyBoundsOf, AreThoseOfFeetThatNeitherSlipNorLift) {
  const std::array<AxisBounds, 6> bounds = body_bounds(legged_robot(GetParam()));
  for (const std::size_t level : {0, 1}) {
    EXPECT_LT(bounds[level].acceleration, 0.5 * 0.5 * kGravity);
    EXPECT_GT(bounds[level].acceleration, 0.5 * 0.5 * 0.5 * kGravity);
  }
  EXPECT_NEAR(bounds[2].acceleration, 0.5 * kGravity, 0.2 * 0.5 * kGravity);
  for (const std::size_t turn : {3, 4, 5}) {
    EXPECT_GT(bounds[turn].acceleration, 10);
    EXPECT_LE(bounds[turn].speed, 0.9);
  }
  EXPECT_GT(bounds[3].acceleration, bounds[4].acceleration) << "a body that is longer than wide rolls more easily";
}

TEST_P(BodyBoundsOf, AreFiniteAndPositiveForLegsThatDoNotReachTheGround) {
  LegModel robot = legged_robot(GetParam());
  EXPECT_FALSE(short_leg(robot).has_value());
  robot.belly += 10;  // m, and the ground with it
  robot.legs[0].foot_radius = -10;
  EXPECT_EQ(short_leg(robot), LegPlace::kRearRight);
  for (const AxisBounds& bounds : body_bounds(robot)) {
    EXPECT_GE(bounds.acceleration, 0.1);
    EXPECT_LE(bounds.acceleration, 1000);
  }
}

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

INSTANTIATE_TEST_SUITE_P(Robots, BodyBoundsOf, testing::ValuesIn(legged_robots()), robot_name);

}  // namespace
}  // namespace robot_control
