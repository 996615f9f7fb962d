#include "robots/wheeled/within_drives.h"

#include <filesystem>
#include <fstream>

#include "machine/wheeled/drive_train.h"
#include "support/matchers.h"
#include "support/robots/diffbot_urdf.h"

namespace robot_control::tests {

/// Diffbot has 3.5 N·m and 30 rad/s, and no torque rate of its own.
struct WithinDrives : ::testing::Test {
  Parameters limited(const std::string& left, const std::string& right = "") {
    std::ofstream(path_) << "bus: {dialect: cia402}\n"
                         << "every_joint: {torque_limit: 4, velocity_limit: 30, gear: 2}\n"
                         << "left_wheel_joint: {node: 1" << left << "}\nright_wheel_joint: {node: 2" << right << "}\n";
    Parameters parameters;
    parameters.drives = path_;
    return within_drives(parameters, diffbot_urdf());
  }
  void TearDown() override { std::filesystem::remove(path_); }

  std::string path_ = ::testing::TempDir() + "within_drives.yaml";
};

TEST_F(WithinDrives, DrivesThatCanDoMoreChangeNothing) {
  const Parameters parameters = limited("");
  EXPECT_FALSE(parameters.robot.wheel_velocity_limit);
  EXPECT_FALSE(parameters.robot.wheel_effort_limit);
  EXPECT_FALSE(parameters.robot.wheel_effort_rate);
  EXPECT_THAT(parameters.warnings, IsEmpty());
}

TEST_F(WithinDrives, TheSmallestLimitOfADriveIsThatOfEveryWheelAndIsNamed) {
  const Parameters parameters = limited(", velocity_limit: 6", ", velocity_limit: 5, torque_limit: 2");
  EXPECT_EQ(parameters.robot.wheel_velocity_limit, 5);
  EXPECT_EQ(parameters.robot.wheel_effort_limit, 2);
  EXPECT_THAT(
      parameters.warnings,
      ElementsAre(
          HasSubstr("robot.wheel_velocity_limit = 5 rad/s, which the drive of right_wheel_joint has in " + path_),
          HasSubstr("robot.wheel_effort_limit = 2 N·m")));
  const DriveTrain robot = read_drive_train(diffbot_urdf(), parameters.robot);
  EXPECT_EQ(robot.joints[0].velocity_limit, 5);
}

TEST_F(WithinDrives, ASlopeOfTheTorqueIsThatOfTheJoint) {
  EXPECT_EQ(limited(", torque_slope: 3").robot.wheel_effort_rate, 6);
}

TEST_F(WithinDrives, ASecondTimeChangesNothing) {
  const Parameters once = limited(", velocity_limit: 5");
  const Parameters twice = within_drives(once, diffbot_urdf());
  EXPECT_EQ(twice.robot.wheel_velocity_limit, 5);
  EXPECT_EQ(twice.warnings, once.warnings);
}

}  // namespace robot_control::tests
