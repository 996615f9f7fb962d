#include "navigation/guard/motion_clearance.h"

#include <gtest/gtest.h>

#include "navigation/house.h"

namespace robot_control::navigation::tests {

using testing_house::diffbot;

double free_of(std::vector<Point> points, PlanarMotion motion) {
  return free_way(diffbot(), points, motion).distance;
}

TEST(FreeWayTest, ItEndsBeforeTheObstacleAheadOrBehind) {
  EXPECT_NEAR(free_of({{1.12, 0}}, {0.5, 0}), 1.0 - kLaserNoise - kRemainingGap, 0.021);
  EXPECT_NEAR(free_of({{1.12, 0}}, {0, 0}), 1.0 - kLaserNoise - kRemainingGap, 0.021);
  EXPECT_NEAR(free_of({{-1.28, 0}}, {-0.5, 0}), 1.0 - kLaserNoise - kRemainingGap, 0.021);
  EXPECT_TRUE(std::isinf(free_of({{1.12, 0}}, {-0.5, 0})));
  EXPECT_TRUE(std::isinf(free_of({{1.12, 0.3}}, {0.5, 0})));
  EXPECT_TRUE(std::isinf(free_of({}, {0.5, 0})));
}

TEST(FreeWayTest, ItFollowsTheArc) {
  const double radius = 1, angle = 1.2;
  const Point on_arc{radius * std::sin(angle), radius * (1 - std::cos(angle))};
  EXPECT_NEAR(free_of({on_arc}, {0.5, 0.5}), radius * angle - 0.12 - kLaserNoise - kRemainingGap, 0.1);
  EXPECT_TRUE(std::isinf(free_of({on_arc}, {0.5, -0.5})));
}

TEST(FreeWayTest, ATurnOnTheSpotEndsWhereACornerTouches) {
  const Point beside_tail{-0.25, 0.23};  // the tail's left corner turns right into it
  EXPECT_LT(free_of({beside_tail}, {0, -0.5}), 0.3 * diffbot().half_width);
  EXPECT_TRUE(std::isinf(free_of({{0.5, 0.5}}, {0, 0.5})));
}

TEST(FreeWayTest, WhatTouchesOnlyHindersWhatComesNearer) {
  const Point at_the_nose{0.125, 0};
  EXPECT_EQ(free_of({at_the_nose}, {0.5, 0}), 0);
  EXPECT_TRUE(std::isinf(free_of({at_the_nose}, {-0.5, 0})));
}

TEST(FreeWayTest, APointInsideTheOutlineIsAPartOfTheRobotBeyondTheNoise) {
  EXPECT_TRUE(std::isinf(free_of({{0.05, 0.05}}, {0.5, 0})));
  EXPECT_EQ(free_of({{0.11, 0}}, {0.5, 0}), 0);
}

TEST(FreeWayTest, AMotionToTheSideEndsBesideTheOutline) {
  EXPECT_NEAR(free_of({{0, 1.27}}, {.lateral = 0.5}), 1.0 - kLaserNoise - kRemainingGap, 0.03);
  EXPECT_TRUE(std::isinf(free_of({{0, 1.27}}, {.lateral = -0.5})));
  EXPECT_TRUE(std::isinf(free_of({{1.12, 0}}, {.lateral = 0.5})));
}

TEST(FreeWayTest, ItNamesTheFirstObstacle) {
  const FreeWay free = free_way(diffbot(), {{2, 0}, {1, 0}, {3, 0.1}, {0.5, 1}}, {0.5, 0});
  ASSERT_TRUE(free.obstacle);
  EXPECT_EQ(free.obstacle->x, 1);
}

}  // namespace robot_control::navigation::tests
