#include "navigation/mapping/scan_matcher.h"

#include <gtest/gtest.h>

namespace robot_control::navigation::tests {

/// Walls of a corridor along x, 2 m wide, and of a room with a niche.
struct ScanMatcherTest : testing::Test {
  static std::vector<WallPoint> corridor() {
    std::vector<WallPoint> points;
    for (double x = -6; x < 6; x += 0.05) points.push_back({{x, 1}, {0, -1}}), points.push_back({{x, -1}, {0, 1}});
    return points;
  }
  static std::vector<WallPoint> room() {
    std::vector<WallPoint> points = corridor();
    for (double y = -1; y < 1; y += 0.05) points.push_back({{-6, y}, {1, 0}}), points.push_back({{6, y}, {-1, 0}});
    for (double y = 1; y < 2; y += 0.05) points.push_back({{2, y}, {1, 0}});
    return points;
  }
  static UncertainPose predicted(const PlanarPose& pose, double distance, double turn) {
    return {pose, Eigen::Vector3d(distance * distance, distance * distance, turn * turn).asDiagonal()};
  }
};

TEST_F(ScanMatcherTest, FindsThePoseInARoom) {
  const Match found = match({room(), 0.05}, room(), {0.1, -0.1, 0.03}, predicted({0.1, -0.1, 0.03}, 0.2, 0.1));
  EXPECT_NEAR(found.pose.mean.x, 0, 0.01);
  EXPECT_NEAR(found.pose.mean.y, 0, 0.01);
  EXPECT_NEAR(found.pose.mean.yaw, 0, 0.003);
  EXPECT_GE(found.matched, static_cast<int>(room().size()) - 8) << "in a corner the nearest wall is that beside it";
}

/// All walls in sight are parallel.
TEST_F(ScanMatcherTest, AlongACorridorTheOdometryDecides) {
  const Match found = match({corridor(), 0.05}, corridor(), {0.1, -0.1, 0.03}, predicted({0.1, -0.1, 0.03}, 0.2, 0.1));
  EXPECT_NEAR(found.pose.mean.x, 0.1, 0.01);
  EXPECT_NEAR(found.pose.mean.y, 0, 0.01);
  EXPECT_GT(std::sqrt(found.pose.covariance(0, 0)), 0.1);
  EXPECT_LT(std::sqrt(found.pose.covariance(1, 1)), 0.02);
}

TEST_F(ScanMatcherTest, ASearchFindsAPoseFarAway) {
  PointField field(room(), 0.05);
  const PlanarPose truth{1.3, -0.4, 0.8};
  const auto found = field.search(moved(room(), inverse(truth)), {{0, 0, 0}, 2, 1.5}, 0.5);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->pose.x, truth.x, 0.06);
  EXPECT_NEAR(found->pose.y, truth.y, 0.06);
  EXPECT_NEAR(found->pose.yaw, truth.yaw, 0.02);
  EXPECT_FALSE(field.search(moved(room(), inverse(truth)), {{0, 0, 0}, 0.5, 0.2}, 0.5)) << "it is outside the window";
}

/// One that ends early proves neither the best place nor that no other one is as good.
TEST_F(ScanMatcherTest, ASearchThatEndsEarlySaysSo) {
  PointField field(room(), 0.05);
  const SearchWindow window{{0, 0, 0}, 2, 1.5};
  for (const int bounds : {0, 1, 100, 1000}) {
    const auto found = field.search(room(), window, 0.5, nullptr, bounds);
    ASSERT_TRUE(found) << bounds;
    EXPECT_FALSE(found->proven) << bounds;
    const auto other = field.search(room(), window, 0.95, &found->pose, bounds);
    ASSERT_TRUE(other) << bounds;
    EXPECT_FALSE(other->proven) << bounds;
  }
  const auto found = field.search(room(), window, 0.5);
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->proven);
}

}  // namespace robot_control::navigation::tests
