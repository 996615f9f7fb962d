#include <gtest/gtest.h>

#include "loop/cycle_fixture.h"

namespace robot_control::tests {

// Exactly, and in the very next cycle: a program that sets a pose may compare with ==.
TEST(PoseRequest, HoldsExactlyFromTheNextCycleOn) {
  Loop loop;
  loop.steps(400);  // longer than the window in which the robot comes to stand
  loop.estimator->request_pose({1.5, -2.5, 0});
  EXPECT_EQ(loop.newest_state().base.pose_odom.position[0], 0);
  loop.step();
  const StateFrame state = loop.newest_state();
  EXPECT_EQ(state.base.pose_odom.position[0], 1.5);
  EXPECT_EQ(state.base.pose_odom.position[1], -2.5);
  EXPECT_EQ(state.base.pose_covariance[0], 0);
  EXPECT_EQ(state.base.pose_covariance[7], 0);
  EXPECT_EQ(state.base.pose_covariance[35], 0);
}

TEST(PoseRequest, IsTheLastOfTwoInOneCycle) {
  Loop loop;
  loop.steps(10);
  loop.estimator->request_pose({1, 1, 1});
  loop.estimator->request_pose({2, 3, 0});
  loop.step();
  EXPECT_EQ(loop.newest_state().base.pose_odom.position[0], 2);
  EXPECT_EQ(loop.newest_state().base.pose_odom.position[1], 3);
}

}  // namespace robot_control::tests
