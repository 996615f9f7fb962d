#include "ros/messages/time_map.h"

#include <gtest/gtest.h>
#include <ros/time.h>

#include <random>

#include "ros/nanoseconds.h"
#include "rt/clock.h"

namespace robot_control::tests {

TEST(TimeMap, AddsTheMeasuredOffset) {
  TimeMap map(ClockMode::kWall);
  map.update(5 * kSecond, 1000 * kSecond);
  EXPECT_EQ(map.ros_ns(5 * kSecond), 1005 * kSecond);
}

TEST(TimeMap, FollowsAClockThatWasSetForward) {
  TimeMap map(ClockMode::kWall);
  map.update(5 * kSecond, 1000 * kSecond);
  map.update(6 * kSecond, 2000 * kSecond);
  EXPECT_EQ(map.ros_ns(6 * kSecond), 2006 * kSecond);
}

TEST(TimeMap, SlowsDownWhenTheClockWasSetBackUntilItIsCaughtUp) {
  TimeMap map(ClockMode::kWall);
  map.update(10 * kSecond, 1000 * kSecond);
  map.update(11 * kSecond, 999 * kSecond);
  EXPECT_EQ(map.ros_ns(11 * kSecond), 1010 * kSecond + kSecond / 2);
  map.update(14 * kSecond, 999 * kSecond);
  EXPECT_EQ(map.ros_ns(14 * kSecond), 1013 * kSecond);
}

TEST(TimeMap, NeverTurnsBack) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  std::uniform_int_distribution<std::int64_t> step(1, kSecond / 100);
  std::uniform_int_distribution<std::int64_t> offset(900 * kSecond, 1100 * kSecond);
  TimeMap map(ClockMode::kWall);
  std::int64_t last = 0;
  std::int64_t stamp = 0;
  for (int i = 0; i < 10'000; ++i) {
    stamp += step(random);
    map.update(stamp, offset(random));
    ASSERT_GT(map.ros_ns(stamp), last) << i;
    last = map.ros_ns(stamp);
  }
}

TEST(TimeMap, IsTheTimeOfDayOnTheWallClock) {
  TimeMap map(ClockMode::kWall);
  const std::int64_t now_ns = monotonic_ns();
  SensorFrame sensors;
  sensors.head.stamp_ns = now_ns;
  map.follow(sensors);
  EXPECT_NEAR(map.at(now_ns).toSec(), ros::WallTime::now().toSec(), 10.0);  // s; a machine may stall in between
}

TEST(TimeMap, AddsWhatASimulatedPlantLetSlip) {
  TimeMap map(ClockMode::kWall);
  SensorFrame sensors;
  sensors.slipped_ns = 3 * kSecond;
  sensors.head.stamp_ns = monotonic_ns() - 3 * kSecond;
  map.follow(sensors);
  const std::int64_t now_ns = static_cast<std::int64_t>(ros::WallTime::now().toNSec());
  EXPECT_NEAR(static_cast<double>(map.ros_ns(sensors.head.stamp_ns)), static_cast<double>(now_ns), 1e9);
}

TEST(TimeMap, AddsWhatASimulatedPlantWasHeld) {
  TimeMap map(ClockMode::kWall);
  SensorFrame sensors;
  sensors.held_ns = 100 * kSecond;
  sensors.head.stamp_ns = monotonic_ns() - 100 * kSecond;
  map.follow(sensors);
  const std::int64_t now_ns = static_cast<std::int64_t>(ros::WallTime::now().toNSec());
  EXPECT_NEAR(static_cast<double>(map.ros_ns(sensors.head.stamp_ns)), static_cast<double>(now_ns), 1e9);
}

TEST(TimeMap, IsTheStampItselfInLockstep) {
  TimeMap map(ClockMode::kLockstep);
  SensorFrame sensors;
  sensors.head.stamp_ns = 7 * kSecond;
  map.follow(sensors);
  EXPECT_EQ(map.ros_ns(7 * kSecond), 7 * kSecond);
}

}  // namespace robot_control::tests
