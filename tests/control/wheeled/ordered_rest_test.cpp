/// Checks that a requested rest ends in the brake, whether the wheel loops got there or not.

#include <gtest/gtest.h>

#include "control/wheeled/control_bench.h"

namespace robot_control::tests {

constexpr double kDegree = std::numbers::pi / 180;

/// Healthy case: 0.5 m/s on the level, and loops that are as slow as 20 Hz make them.
struct OrderedRest : testing::Test {
  OrderedRest() {
    bench.run(0.5);
    bench.send(0.5, 0);
    bench.run(1);
    bench.send(0, 0);
  }

  bool holds() const { return (bench.command.reasons & kReasonHolding) != 0; }
  bool plan_ended() const { return bench.command.twist_limited.linear[0] == 0; }

  /// s, until it holds, at most 5
  double time_until_it_holds() {
    const std::uint64_t begin = bench.cycle;
    do bench.step();
    while (!holds() && bench.cycle < begin + 100);
    return static_cast<double>(bench.cycle - begin) * bench.period;
  }

  ControlBench bench{make_test_robot(), straight_ramps(), 0.05};
};

TEST_F(OrderedRest, EndsByStandstillOnTheLevel) {
  while (!plan_ended()) bench.step();
  EXPECT_LT(time_until_it_holds(), kRestTime);
}

TEST_F(OrderedRest, EndsWithinItsTimeThoughTheWheelsCreepOn) {
  while (!plan_ended()) bench.step();
  bench.plant.slope = -0.3 * kDegree;  // 0.05 m/s² downhill
  EXPECT_NEAR(time_until_it_holds(), kRestTime, 2 * bench.period);
}

TEST_F(OrderedRest, EndsWithinItsWayThoughTheWheelsRunOn) {
  while (!plan_ended()) bench.step();
  const double begin = bench.plant.distance + bench.plant.twist.linear * 2 * bench.period;
  bench.plant.slope = -5 * kDegree;
  EXPECT_LT(time_until_it_holds(), kRestTime - bench.period);
  EXPECT_LT(bench.plant.distance - begin, kRestWay + 0.03) << "what a cycle adds at that speed";
}

TEST_F(OrderedRest, EndsDuringTheRampWhereTheWheelsLeaveThePlan) {
  for (const double slope : {-15.0, 15.0}) {
    bench.send(0.5, 0);
    bench.plant.slope = 0;
    bench.run(1);
    bench.send(0, 0);
    bench.plant.slope = slope * kDegree;
    EXPECT_LT(time_until_it_holds(), 0.45) << slope;
  }
}

TEST_F(OrderedRest, IsNoReasonToBrakeWhileAMotionIsRequested) {
  bench.send(0.5, 0);
  bench.plant.slope = -5 * kDegree;
  for (int k = 0; k < 24; ++k) {  // the command is in force for 1.25 s
    bench.step();
    ASSERT_EQ(bench.command.joints[0].mode, JointMode::kEffort) << k;
  }
}

}  // namespace robot_control::tests
