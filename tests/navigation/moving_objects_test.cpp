#include "navigation/moving_objects.h"

#include <gtest/gtest.h>

#include "navigation/guard/motion_clearance.h"
#include "navigation/house.h"

namespace robot_control::navigation::tests {

using namespace testing_house;

constexpr double kScanPeriod = 0.1;  // s

/// An empty hall of 10 m, 5 m ahead of its lower left corner the laser, and a box of 0.5 m in it.
struct MoversTest : testing::Test {
  Scan seen(Point box) const {
    Grid world;
    world.columns = world.rows = 100, world.resolution = kCell;
    world.cells.assign(10'000, kFreeCell);
    for (int row = 0; row < 100; ++row) {
      for (int column = 0; column < 100; ++column) {
        const bool in_box = std::abs(world.x_of(column) - box.x) < 0.25 && std::abs(world.y_of(row) - box.y) < 0.25;
        const bool wall = row == 0 || column == 0 || row == 99 || column == 99;
        if (wall || in_box) world.cells[world.index({column, row})] = kOccupiedCell;
      }
    }
    return scan_of(world, sensor_);
  }

  /// The objects after a second in which box and laser have these speeds, m/s, both in x.
  std::vector<MovingObject> after_a_second(double box_speed, double own_speed = 0) {
    std::vector<MovingObject> found;
    for (int i = 0; i <= 10; ++i) {
      sensor_.x = 3 + own_speed * i * kScanPeriod;
      found = objects_.update(seen({5 + box_speed * i * kScanPeriod, 7}), sensor_, i * kScanPeriod);
    }
    return found;
  }

  PlanarPose sensor_{3, 5, 0};
  MovingObjects objects_;
};

TEST_F(MoversTest, AThingThatMovesHasItsVelocity) {
  const std::vector<MovingObject> found = after_a_second(0.8);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].velocity.x, 0.8, 0.3);  // one cell of the world in 0.4 s
  EXPECT_NEAR(found[0].velocity.y, 0, 0.3);
}

TEST_F(MoversTest, WhatStandsDoesNotMoveWhereTheRobotDrivesPastIt) {
  EXPECT_TRUE(after_a_second(0, 0.5).empty());
  EXPECT_TRUE(after_a_second(0).empty());
}

TEST_F(MoversTest, APieceOfWallAlongWhichRaysGrazeStands) {
  for (int i = 0; i <= 20; ++i) {
    sensor_ = {0, 0, 0.0195 * i};  // between two scans 0.4 s apart the rays lie half a step beside each other
    Scan scan{-M_PI, 2 * M_PI / 360, 0.1, 12, std::vector<float>(360, 9)};
    for (std::size_t ray = 0; ray < scan.ranges.size(); ++ray) {
      const double angle = sensor_.yaw + scan.angle(ray), x = 0.7 / std::tan(angle);  // where y is 0.7 m
      if (std::sin(angle) > 0 && x > 2.6 && x < 3.4) scan.ranges[ray] = static_cast<float>(std::hypot(x, 0.7));
    }
    EXPECT_TRUE(objects_.update(scan, sensor_, i * kScanPeriod).empty()) << "scan " << i;
  }
}

/// A thing of one point with its velocity, in base axes.
std::vector<MovingObject> object(Point point, Point velocity) {
  return {{{point}, velocity}};
}

TEST(PlacesAheadTest, TheyAreThoseOfWhatPassesAStandingRobot) {
  EXPECT_EQ(predicted_points(object({1.12, 0}, {-0.5, 0}), diffbot()).size(), 1U) << "it comes: where it is";
  const std::vector<Point> ahead = predicted_points(object({1.12, 0.5}, {-0.5, 0}), diffbot());
  ASSERT_FALSE(ahead.empty());
  EXPECT_NEAR(ahead.back().x, 1.12 - 0.5 * kPredictionTime, 0.051);
}

TEST(ForeseeTest, PathsAvoidWhatComesToTheRobotAndTheLocalControlHasItsVelocity) {
  const Grid map = two_rooms(0.8);
  Costmap costmap(map, diffbot(), false);
  const PlanarPose base{1.6, 1.6, 0};
  for (const Point velocity : {Point{-0.5, 0}, Point{0, 0.5}}) {
    Grid world = map;
    world.cells[world.index({26, 16})] = kOccupiedCell;
    costmap.insert(scan_of(world, base), base, 1);
    const std::vector<MovingObject> seen = composed(base, object({1.05, 0.05}, velocity));
    foresee(seen, base, costmap);
    EXPECT_NEAR(seen[0].points[0].x, 2.65, 1e-9);
    costmap.update(1);
    EXPECT_TRUE(costmap.occupied({26, 16})) << velocity.x;
    costmap.update(1, false);
    EXPECT_FALSE(costmap.occupied({26, 16})) << velocity.x;
  }
}

TEST(MoversSeenFromTest, TheyAreTurnedIntoTheAxesOfTheBase) {
  const MovingObject seen = composed(inverse({2, 0, M_PI / 2}), object({2, 1}, {0.5, 0}))[0];
  EXPECT_NEAR(seen.points[0].x, 1, 1e-9);
  EXPECT_NEAR(seen.points[0].y, 0, 1e-9);
  EXPECT_NEAR(seen.velocity.y, -0.5, 1e-9);
}

TEST(FreeWayAmongMoversTest, ItEndsWhereOneCrosses) {
  const std::vector<MovingObject> crossing = object({1.12, -1.5}, {0, 0.8});
  EXPECT_NEAR(free_way(diffbot(), {}, {0.5, 0}, crossing).distance, 1.0 - kLaserNoise - kRemainingGap, 0.021);
}

TEST(FreeWayAmongMoversTest, OneThatComesToTheRobotEndsItAtTheMeeting) {
  const std::vector<MovingObject> oncoming = object({1.12, 0}, {-0.5, 0});
  EXPECT_NEAR(free_way(diffbot(), {}, {0.5, 0}, oncoming).distance, 0.5 - kRemainingGap, 0.05);
}

TEST(FreeWayAmongMoversTest, TheRobotDrivesOnOutOfTheWayOfOneThatWouldTouchIt) {
  const std::vector<MovingObject> from_the_side = object({0, -1.27}, {0, 0.5});
  EXPECT_TRUE(std::isinf(free_way(diffbot(), {}, {0.5, 0}, from_the_side).distance));
}

}  // namespace robot_control::navigation::tests
