/// A robot on legs behind motors in MIT mode, which close the impedances of its joints, on four CAN buses.

#include "robots/quadruped_fixture.h"
#include "support/matchers.h"

namespace robot_control::tests {

Parameters behind_drives() {
  Parameters parameters = QuadrupedLoop::parameters(0, ErrorLevel::kIdeal);
  parameters.drives = PROJECT_DIRECTORY "/config/drives/damiao.yaml";
  return parameters;
}

TEST(BehindDrives, ItStandsUpAndWalksAsAsked) {
  QuadrupedLoop robot = loop_of(behind_drives());
  robot.run(3.5, walk(0.5));
  EXPECT_EQ(robot.loop.row().driver->sensors.driver_state, DriverState::kRunning);
  EXPECT_EQ(robot.loop.row().driver->sensors.link_count, 4u);
  const double from = robot.truth().pose_world.position[0];
  robot.run(4, walk(0.5));
  EXPECT_NEAR(robot.truth().pose_world.position[0] - from, 2.0, 0.06);  // 3 % of the way
  EXPECT_LT(robot.tilt, 0.15);
}

TEST(BehindDrives, ABusThatGoesStopsItAndItFoldsUpright) {
  QuadrupedLoop robot = loop_of(behind_drives());
  robot.run(5, walk(0.5));
  robot.clear();
  robot.loop.inject_fault("can1", "off");
  robot.wait(3);
  EXPECT_EQ(robot.loop.row().driver->sensors.driver_state, DriverState::kFault);
  EXPECT_LT(robot.tilt_now(), 0.3);
  EXPECT_LT(robot.speed(), 0.01);
}

}  // namespace robot_control::tests
