#include "control/legged/body_bounds.h"

#include <gtest/gtest.h>

#include "machine/gravity.h"
#include "robots/quadruped_fixture.h"

namespace robot_control {
namespace {

class BodyBoundsOf : public testing::TestWithParam<std::string> {};

/// A body that is a point at the feet's middle on the ground would reach μ g ahead and sideways, and g upwards. kPart
/// is a half. Height, and legs that move with the body, take some of it.
TEST_P(BodyBoundsOf, AreThoseOfFeetThatNeitherSlipNorLift) {
  const LegModel robot = legged_robot(GetParam());
  const LegController controller(robot, 1, 0.001);
  const double ground = robot.belly, height = controller.tuning().height + robot.belly;
  const std::array<AxisBounds, 6> bounds = body_bounds(robot, height, ground);
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

TEST_P(BodyBoundsOf, AreFiniteAndPositiveWhereTheLegsDoNotReachTheGround) {
  for (const double height : {-1.0, 0.0, 10.0}) {
    for (const AxisBounds& bounds : body_bounds(legged_robot(GetParam()), height, 0)) {
      EXPECT_GE(bounds.acceleration, 0.1) << height;
      EXPECT_LE(bounds.acceleration, 1000) << height;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Robots, BodyBoundsOf, testing::ValuesIn(legged_robots()), robot_name);

}  // namespace
}  // namespace robot_control
