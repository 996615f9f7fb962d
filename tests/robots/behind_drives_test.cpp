/// A robot on legs behind motors in MIT mode, which close the impedances of its joints, on four CAN buses.

#include <filesystem>
#include <fstream>
#include <span>

#include "drivers/drive/can_drive_file.h"
#include "drivers/table/drive_table.h"
#include "drivers/table/factory.h"
#include "drivers/table/read_drive_file.h"
#include "robots/quadruped_fixture.h"
#include "simulation/machines/simulated_machine.h"
#include "support/matchers.h"

namespace robot_control::tests {

Parameters behind_drives(const std::string& drives = "damiao") {
  Parameters parameters = QuadrupedLoop::parameters(0, ErrorLevel::kDataSheet);
  parameters.drives = PROJECT_DIRECTORY "/config/drives/" + drives + ".yaml";
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
  for (const char* drives : {"damiao", "cybergear", "ak", "moteus"}) {
    SCOPED_TRACE(drives);
    QuadrupedLoop robot = loop_of(behind_drives(drives));
    EXPECT_EQ(robot.loop.row().driver->sensors.link_count, 4u);
    expect_walking(robot);
  }
}

TEST(BehindDrives, ItWalksOnWhileFramesAreLostAndLate) {
  for (const std::string kind : {"lossy", "disturbed"}) {
    for (const double rate : {1000, 500}) {
      Parameters parameters = behind_drives();
      parameters.loop.rate = rate;
      QuadrupedLoop robot = loop_of(parameters);
      robot.loop.inject_fault("bus", kind);
      expect_walking(robot);
    }
  }
}

/// Twelve samples, or 18 ms: five samples of 2 ms are lost in a row once in 20 s, on a bus that loses 5 % each way.
TEST(BehindDrives, TheMonitorWaitsForSamplesAsLongAsADriveDoes) {
  for (const auto& [rate, missing] : {std::pair{1000.0, 12U}, std::pair{500.0, 9U}, std::pair{250.0, 4U}}) {
    Parameters parameters = behind_drives();
    parameters.loop.rate = rate;
    const LegModel robot = legged_robot("quadbot");
    EXPECT_NEAR(tolerated_silence(parameters, true), missing / rate, 1e-12) << rate;
    std::vector<std::string> joints;
    for (const JointModel& joint : robot.joints) joints.push_back(joint.name);
    const std::unique_ptr<DriveFile> file = read_drive_file(parameters, joints);
    EXPECT_EQ(dynamic_cast<CanDriveFile&>(*file).drives()[0].drive_parameters().max_silence, missing) << rate;
  }
}

TEST(BehindDrives, ItWalksAgainAfterAResetOfTheSimulation) {
  QuadrupedLoop robot = loop_of(behind_drives());
  robot.run(5, walk(0.5));
  robot.loop.reset();
  robot.wait(0.3);
  expect_walking(robot);
}

/// An AK motor whose bus is lost keeps its last order for ever, so these losses are not among its own.
TEST(BehindDrives, ItFoldsUprightWhenADriveOrABusIsLost) {
  const std::pair<std::string, std::string> losses[] = {{"bus", "off"},
                                                        {"can1", "off"},
                                                        {"front_left_knee_joint", "off"},
                                                        {"rear_left_hip_joint", "released"},
                                                        {"front_right_thigh_joint", "encoder"},
                                                        {"rear_right_thigh_joint", "hot"},
                                                        {"rear_right_knee_joint", "other_zero"}};
  for (const std::string drives : {"damiao", "cybergear", "ak", "moteus"}) {
    for (const auto& [component, kind] : std::span(losses).subspan(drives == "ak" ? 2 : 0)) {
      SCOPED_TRACE(drives + " " + component + " " + kind);
      QuadrupedLoop robot = loop_of(behind_drives(drives));
      robot.run(5, walk(0.5));
      ASSERT_EQ(robot.causes(), "");
      robot.clear();
      robot.loop.inject_fault(component, kind);
      int cycles = 0;
      for (; robot.causes().empty() && cycles < 150; ++cycles) robot.step();
      EXPECT_LE(cycles, drives == "ak" && kind == "released" ? 150 : 20);
      robot.wait(3);
      EXPECT_THAT(robot.causes(), HasSubstr("driver_fault"));
      EXPECT_LT(robot.tilt, 0.6);
      EXPECT_LT(robot.tilt_now(), 0.2);
      EXPECT_LT(robot.truth().pose_world.position[2], 0.05);
      EXPECT_LT(robot.speed(), 0.01);
    }
  }
}

void expect_found_by_another_program(const std::string& drives) {
  const std::string folder = testing::TempDir() + "leg_bus_";
  const std::string path = testing::TempDir() + "leg_drives.yaml";
  Parameters parameters = behind_drives(drives);
  std::ifstream example(parameters.drives);
  std::string text{std::istreambuf_iterator<char>(example), {}};
  for (const std::string bus : {"can0", "can1", "can2", "can3"}) {
    for (std::size_t at = 0; (at = text.find(bus, at)) != std::string::npos;)
      text.replace(at, bus.size(), "unix:" + folder + bus.back());
  }
  std::ofstream(path) << text;
  parameters.drives = path;
  const std::vector<Word> words = words_of(DriverName());
  parameters.driver = static_cast<DriverName>(std::ranges::find(words, "can", &Word::text)->value);
  const LegModel robot = legged_robot("quadbot");
  const std::vector<Brake> brakes = Quadruped(parameters, robot).brakes();
  std::int64_t now_ns = 0;
  const auto machine = make_device_simulator(parameters, robot, brakes);
  const auto driver = make_driver(parameters, robot, brakes, [&] { return CanTime{.time_ns = now_ns, .utc_ns = 0}; });
  driver->start();
  SensorFrame sensors;
  for (int i = 0; i < 1000; ++i) {
    driver->read(sensors);
    driver->write(std::vector<JointCommand>(kLegsJoints));
    machine->step();
    now_ns += parameters.loop.period_ns();
  }
  EXPECT_EQ(sensors.driver_state, DriverState::kRunning) << driver->warning();
  EXPECT_EQ(sensors.link_count, 4u);
  for (std::size_t i = 0; i < kLegsJoints; ++i) {
    EXPECT_NEAR(sensors.joints[i].position, robot.joints[i].rest_position, 0.02) << i;
  }
  std::filesystem::remove(path);
  for (const char bus : {'0', '1', '2', '3'}) std::filesystem::remove_all(folder + bus);
}

/// The driver and the simulated robot of another program meet on four buses without CAN, with classic frames and with
/// frames of CAN FD.
TEST(BehindDrives, AnotherProgramFindsThemOnEachBus) {
  for (const char* drives : {"damiao", "moteus"}) {
    SCOPED_TRACE(drives);
    expect_found_by_another_program(drives);
  }
}

}  // namespace robot_control::tests
