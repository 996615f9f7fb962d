#include "ros/startup/setup.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ros/nodes/node.h"

namespace robot_control::tests {

using testing::HasSubstr;

TEST(ClockProblem, IsNoneWhenClockAndSimulatedTimeAgree) {
  EXPECT_EQ(clock_problem(ClockMode::kWall, false), "");
  EXPECT_EQ(clock_problem(ClockMode::kLockstep, true), "");
}

TEST(ClockProblem, NamesTheRemedyForALeftover) {
  EXPECT_THAT(clock_problem(ClockMode::kWall, true), HasSubstr("rosparam set /use_sim_time false"));
  EXPECT_THAT(clock_problem(ClockMode::kLockstep, false), HasSubstr("rosparam set /use_sim_time true"));
}

TEST(PublishTick, EndsWhenTheFirstTopicIsDueWithinItsBounds) {
  constexpr std::int64_t kMs = 1'000'000;
  Parameters parameters;
  Pacer slow(1), medium(200), fast(500);
  for (Pacer* topic : {&slow, &medium, &fast}) topic->due(1, 0);
  EXPECT_EQ(publish_tick_ns(parameters, 2 * kMs, {&slow, &medium}), 3 * kMs);
  EXPECT_EQ(publish_tick_ns(parameters, 0, {&slow}), 10 * kMs);
  EXPECT_EQ(publish_tick_ns(parameters, 9 * kMs, {&medium}), 250'000) << "overdue";
  EXPECT_EQ(publish_tick_ns(parameters, 0, {&medium, &fast}), 250'000) << "a quarter of a cycle";
  parameters.loop.clock = ClockMode::kLockstep;
  EXPECT_EQ(publish_tick_ns(parameters, 0, {&slow}), 250'000);
}

}  // namespace robot_control::tests
