/// A robot on legs behind motors in MIT mode, which close the impedances of its joints, on four CAN buses.

#include "robots/quadruped_fixture.h"
#include "support/matchers.h"

namespace robot_control::tests {

Parameters behind_drives() {
  Parameters parameters = QuadrupedLoop::parameters(0, ErrorLevel::kDataSheet);
  parameters.drives = PROJECT_DIRECTORY "/config/drives/damiao.yaml";
  return parameters;
}

/// Walks for 4 s, and expects 3 % of the way.
void expect_walking(QuadrupedLoop& robot) {
  robot.run(3.5, walk(0.5));
  ASSERT_EQ(robot.loop.row().driver->sensors.driver_state, DriverState::kRunning) << robot.loop.warning();
  robot.clear();
  const Vector3 from = robot.truth().pose_world.position;
  robot.run(4, walk(0.5));
  const Vector3& to = robot.truth().pose_world.position;
  EXPECT_NEAR(std::hypot(to[0] - from[0], to[1] - from[1]), 2, 0.06);
  EXPECT_LT(robot.tilt, 0.05);
}

TEST(BehindDrives, ItStandsUpAndWalksAsAsked) {
  QuadrupedLoop robot = loop_of(behind_drives());
  EXPECT_EQ(robot.loop.row().driver->sensors.link_count, 4u);
  expect_walking(robot);
}

TEST(BehindDrives, ItWalksOnWhileFramesAreLostAndLate) {
  for (const std::string kind : {"lossy", "disturbed"}) {
    QuadrupedLoop robot = loop_of(behind_drives());
    robot.loop.inject_fault("bus", kind);
    expect_walking(robot);
  }
}

TEST(BehindDrives, ItWalksAgainAfterAResetOfTheSimulation) {
  QuadrupedLoop robot = loop_of(behind_drives());
  robot.run(5, walk(0.5));
  robot.loop.reset();
  robot.wait(0.3);
  expect_walking(robot);
}

TEST(BehindDrives, ItFoldsUprightWhenADriveOrABusIsLost) {
  const std::pair<std::string, std::string> losses[] = {{"bus", "off"},
                                                        {"can1", "off"},
                                                        {"front_left_knee_joint", "off"},
                                                        {"rear_left_hip_joint", "released"},
                                                        {"front_right_thigh_joint", "encoder"},
                                                        {"rear_right_thigh_joint", "hot"},
                                                        {"rear_right_knee_joint", "other_zero"}};
  for (const auto& [component, kind] : losses) {
    SCOPED_TRACE(component + " " + kind);
    QuadrupedLoop robot = loop_of(behind_drives());
    robot.run(5, walk(0.5));
    ASSERT_EQ(robot.causes(), "");
    robot.clear();
    robot.loop.inject_fault(component, kind);
    int cycles = 0;
    for (; robot.causes().empty() && cycles < 100; ++cycles) robot.step();
    EXPECT_LE(cycles, 20);
    robot.wait(3);
    EXPECT_THAT(robot.causes(), HasSubstr("driver_fault"));
    EXPECT_LT(robot.tilt, 0.5);
    EXPECT_LT(robot.tilt_now(), 0.05);
    EXPECT_LT(robot.truth().pose_world.position[2], 0.02);
    EXPECT_LT(robot.speed(), 0.01);
  }
}

}  // namespace robot_control::tests
