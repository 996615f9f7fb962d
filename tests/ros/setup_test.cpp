#include "ros/startup/setup.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ros/nodes/node.h"

namespace robot_control {
namespace {

using testing::HasSubstr;

TEST(ClockProblem, IsNoneWhenClockAndSimulatedTimeAgree) {
  EXPECT_EQ(clock_problem(ClockMode::kWall, false), "");
  EXPECT_EQ(clock_problem(ClockMode::kLockstep, true), "");
}

TEST(ClockProblem, NamesTheRemedyForALeftover) {
  EXPECT_THAT(clock_problem(ClockMode::kWall, true), HasSubstr("rosparam set /use_sim_time false"));
  EXPECT_THAT(clock_problem(ClockMode::kLockstep, false), HasSubstr("rosparam set /use_sim_time true"));
}

TEST(PublishTick, IsAQuarterOfTheShortestIntervalWithinItsBounds) {
  Parameters parameters;
  EXPECT_EQ(publish_tick_ns(parameters, {50, 250}), 1'000'000);
  EXPECT_EQ(publish_tick_ns(parameters, {1}), 2'000'000);
  EXPECT_EQ(publish_tick_ns(parameters, {2000}), 250'000);
  parameters.loop.clock = ClockMode::kLockstep;
  EXPECT_EQ(publish_tick_ns(parameters, {1}), 250'000);
}

}  // namespace
}  // namespace robot_control
