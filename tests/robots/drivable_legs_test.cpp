/// A robot on legs that cannot stand is refused.

#include <filesystem>
#include <fstream>

#include "robots/quadruped_fixture.h"
#include "support/matchers.h"
#include "support/message_of.h"

namespace robot_control::tests {

/// Returns why it is refused; empty: it is not.
std::string refusal_of(const LegModel& robot) {
  try {
    Quadruped(QuadrupedLoop::parameters(0, ErrorLevel::kIdeal), robot).require_drivable();
    return {};
  } catch (const ParameterError& error) {
    return error.what();
  }
}

TEST(Quadruped, IsRefusedAtARateAtWhichItFalls) {
  Parameters parameters = QuadrupedLoop::parameters(0, ErrorLevel::kIdeal);
  const auto refusal_at = [&](double rate) {
    parameters.loop.rate = rate;
    return message_of<ParameterError>([&] { Quadruped(parameters, legged_robot("quadbot")).require_drivable(); }, "");
  };
  EXPECT_EQ(refusal_at(100), "");
  EXPECT_THAT(refusal_at(99), HasSubstr("robot.rate = 99 Hz: a robot on legs falls below 100 Hz"));
}

TEST(Quadruped, IsRefusedIfItsLegsDoNotReachTheGround) {
  LegModel robot = legged_robot("quadbot");
  robot.legs[0].foot_radius = -10;
  EXPECT_THAT(refusal_of(robot), HasSubstr("does not reach the ground while the robot stands 0.3 m above"));
}

TEST(Quadruped, IsRefusedIfItsKneeDoesNotBearATrot) {
  LegModel robot = legged_robot("quadbot");
  const double needs = 12.7 * 9.81 / 2 * 0.213 * std::sin(std::acos(2 * 0.85 * 0.85 - 1)) / (2 * 0.85);  // N·m
  robot.joints[8].effort_limit = needs / 0.64;
  EXPECT_EQ(refusal_of(robot), "");
  robot.joints[8].effort_limit = needs / 0.66;
  EXPECT_THAT(refusal_of(robot),
              HasSubstr("the knee rear_left_knee_joint needs 6.99 N·m for half of the weight, as in a trot: "
                        "0.66 of its effort limit, at most 0.65. Give"));
}

std::string refusal_with(const std::string& drives) {
  Parameters parameters = QuadrupedLoop::parameters(0, ErrorLevel::kIdeal);
  parameters.drives = drives;
  parameters.loop.rate = 500;
  return message_of<ParameterError>([&] { Quadruped(parameters, legged_robot("quadbot")).require_drivable(); }, "");
}

TEST(Quadruped, IsRefusedBehindDrivesThatDoNotCloseAnImpedance) {
  const std::string path = testing::TempDir() + "odrives.yaml";
  std::ofstream file(path);
  file << "bus: {dialect: odrive}\n"
          "every_joint: {torque_constant: 0.1, torque_limit: 36, velocity_limit: 30, on_silence: coasts}\n";
  int number = 0;
  for (const JointModel& joint : legged_robot("quadbot").joints) {
    file << joint.name << ": {node: " << number << ", bus: can" << number / 3 << "}\n";
    ++number;
  }
  file.close();
  EXPECT_THAT(refusal_with(path), HasSubstr("odrive drives do not close the impedance of a joint by themselves"));
  std::filesystem::remove(path);
}

TEST(Quadruped, IsRefusedBehindDrivesThatAreWeakerThanItsJoints) {
  const std::string example = PROJECT_DIRECTORY "/config/drives/damiao.yaml";
  EXPECT_EQ(refusal_with(example), "");
  std::ifstream file(example);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  text.replace(text.find("torque_limit: 36"), 16, "torque_limit: 35");
  const std::string path = testing::TempDir() + "weak.yaml";
  std::ofstream(path) << text;
  EXPECT_THAT(refusal_with(path), AllOf(HasSubstr("front_left_knee_joint.torque_limit = 35: must be at least the limit "
                                                  "of the joint, 35.55"),
                                        Not(HasSubstr("hip_joint"))));
  std::filesystem::remove(path);
}

TEST(Quadruped, IsRefusedIfTheDriveFileDoesNotMoveAllJoints) {
  EXPECT_THAT(refusal_with(PROJECT_DIRECTORY "/config/drives/odrive.yaml"),
              AllOf(HasSubstr("left_wheel_joint: unknown block"), HasSubstr("rear_right_knee_joint.node: missing")));
}

}  // namespace robot_control::tests
