#include "ros/inputs/odometry_request.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

namespace robot_control::tests {

using testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(OdometryRequest, OfAPlaceOnEarthHasNoProblem) {
  EXPECT_EQ(odometry_problem({1, -2, 3}), "");
  EXPECT_EQ(odometry_problem({1e6, -1e6, 720}), "");
}

TEST(OdometryRequest, ThatIsNoNumberOrFarAwayIsNamedWithItsRule) {
  EXPECT_EQ(odometry_problem({kNan, 0, 0}), "x = nan m: must be a number of -1e+06 … 1e+06 m");
  EXPECT_THAT(odometry_problem({0, -kInfinity, 0}), HasSubstr("y = -inf m"));
  EXPECT_THAT(odometry_problem({0, 0, kInfinity}), HasSubstr("yaw = inf rad"));
  EXPECT_THAT(odometry_problem({0, 1.1e6, 0}), HasSubstr("y = 1100000 m"));
  EXPECT_THAT(odometry_problem({kNan, 0, kNan}), testing::AllOf(HasSubstr("x = nan m"), HasSubstr("; yaw = nan rad")));
}

// The tolerance is the rounding of a few turns.
TEST(OdometryRequest, TurnsYawIntoOneTurn) {
  constexpr double kPi = std::numbers::pi;
  EXPECT_EQ(normalised({1, 2, 0.5}), (Vector3{1, 2, 0.5}));
  EXPECT_NEAR(normalised({0, 0, 6 * kPi + 0.5})[2], 0.5, 1e-14);
  EXPECT_NEAR(normalised({0, 0, -2 * kPi - 0.5})[2], -0.5, 1e-14);
  EXPECT_EQ(normalised({0, 0, -kPi})[2], kPi);
  EXPECT_EQ(normalised({0, 0, kPi})[2], kPi);
}

TEST(OdometryRequest, IsAnsweredWithThePoseThatHolds) {
  EXPECT_EQ(taken_sentence({1, -2.5, 0.5}), "the pose is 1 m, -2.5 m, 0.5 rad from the next cycle on");
}

}  // namespace robot_control::tests
