#include "navigation/guard/collision_guard.h"

#include "navigation/house.h"
#include "support/matchers.h"

namespace robot_control::navigation::tests {

using testing_house::diffbot;

/// The robot stands in a closed room, 1.3 m of base path from the wall ahead and 0.5 m from the one behind.
struct CollisionGuardTest : testing::Test {
  CollisionGuardTest() { insert_scan(base); }

  void insert_scan(const PlanarPose& from, const std::string& laser = "scan") {
    guard.insert(laser, testing_house::scan_of(house, from), {}, from, now);
  }
  double clearance(const PlanarMotion& measured, const PlanarMotion& requested) const {
    return guard.check(base, measured, requested, now).clearance;
  }

  Grid house = testing_house::two_rooms(0);
  PlanarPose base{1.0, 1.6, 0};
  double now = 10;
  CollisionGuard guard{diffbot()};
  const double ahead = 3.1 - 1.0 - 0.12 - kLaserNoise - kRemainingGap;
};

TEST_F(CollisionGuardTest, TheShorterOfTheMeasuredAndTheRequestedArcCounts) {
  EXPECT_NEAR(clearance({0.5, 0}, {0.5, 0}), ahead, 0.05);
  const double behind = clearance({}, {-0.5, 0});
  EXPECT_LT(behind, 0.7);
  EXPECT_EQ(clearance({0.5, 0}, {-0.5, 0}), behind);
  EXPECT_EQ(clearance({-0.5, 0}, {0.5, 0}), behind);
}

TEST_F(CollisionGuardTest, ARobotThatStandsIsMeasuredAgainstItsRequestAndElseAgainstTheWayAhead) {
  EXPECT_NEAR(clearance({0.01, 0}, {}), ahead, 0.05);
  base.x = 2.94;
  EXPECT_NEAR(clearance({0.01, 0}, {0.5, 0}), 0, 0.02);
  EXPECT_GT(clearance({0.01, 0}, {-0.5, 0}), 1);
}

TEST_F(CollisionGuardTest, TheWayIsAtMostTheLookAhead) {
  house.cells.assign(house.cells.size(), kFreeCell);
  guard = CollisionGuard(diffbot());
  insert_scan(base);
  EXPECT_EQ(clearance({0.5, 0}, {0.5, 0}), kLookAhead);
}

TEST_F(CollisionGuardTest, WhatEitherLaserSeesCounts) {
  Scan behind = testing_house::scan_of(house, base);
  behind.ranges.assign(behind.ranges.size(), std::numeric_limits<float>::infinity());
  guard.insert("scan_rear", behind, {}, base, now);
  EXPECT_NEAR(clearance({0.5, 0}, {0.5, 0}), ahead, 0.05);
}

TEST_F(CollisionGuardTest, ADoubtfulLaserLeavesNoWayAndIsNamed) {
  Scan blind = testing_house::scan_of(house, base);
  std::fill(blind.ranges.begin() + 120, blind.ranges.begin() + 240, 0.0F);
  guard.insert("scan", blind, {}, base, now += 0.1);
  const GuardVerdict verdict = guard.check(base, {}, {-0.5, 0}, now);
  EXPECT_EQ(verdict.clearance, 0);
  EXPECT_THAT(verdict.problem, HasSubstr("scan is blind in part"));
}

TEST_F(CollisionGuardTest, AMotionThatIsNotFiniteLeavesNoMoreWay) {
  const double nan = std::nan("");
  EXPECT_LE(clearance({nan, 0}, {0.5, 0}), ahead + 0.05);
}

}  // namespace robot_control::navigation::tests
