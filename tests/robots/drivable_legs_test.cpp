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

/// Returns why the example of a drive is refused in which `old` is replaced by `replacement`.
std::string refusal_with(const std::string& drive, std::string_view old, std::string_view replacement) {
  const std::string example = PROJECT_DIRECTORY "/config/drives/" + drive + ".yaml";
  EXPECT_EQ(refusal_with(example), "");
  std::ifstream file(example);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  text.replace(text.find(old), old.size(), replacement);
  const std::string path = testing::TempDir() + "changed.yaml";
  std::ofstream(path) << text;
  const std::string refusal = refusal_with(path);
  std::filesystem::remove(path);
  return refusal;
}

TEST(Quadruped, IsRefusedBehindDrivesThatAreWeakerThanItsJoints) {
  EXPECT_THAT(refusal_with("damiao", "torque_limit: 36", "torque_limit: 35"),
              AllOf(HasSubstr("front_left_knee_joint.torque_limit = 35: must be at least the limit "
                              "of the joint, 35.55"),
                    Not(HasSubstr("hip_joint"))));
}

/// Quadbot's thigh moves in −0.69 … 4.5 rad, its knee in −2.82 … −0.89 rad, its hip in −0.86 … 0.86 rad.
TEST(Quadruped, IsRefusedBehindMotorsWhosePositionsDoNotReachItsJoints) {
  for (const char* drive : {"damiao", "cybergear", "ak"}) {
    EXPECT_THAT(refusal_with(drive, "velocity_limit: 30", "velocity_limit: 30\n  offset: -8.5"),
                AllOf(HasSubstr("front_left_thigh_joint.position_range: the joint moves in -0.69 … 4.5 rad, but its "
                                "drive holds positions in -21"),
                      HasSubstr("rad only; set a wider position_range"), Not(HasSubstr("knee"))))
        << drive;
  }
  EXPECT_THAT(refusal_with("damiao", "velocity_limit: 30", "velocity_limit: 15\n  direction: -1\n  gear: 2.9"),
              AllOf(HasSubstr("thigh_joint.position_range: the joint moves in -0.69 … 4.5 rad, but its drive holds "
                              "positions in -4.31 … 4.31 rad only"),
                    Not(HasSubstr("knee_joint.position_range"))));
}

TEST(Quadruped, IsRefusedIfTheDriveFileDoesNotMoveAllJoints) {
  EXPECT_THAT(refusal_with(PROJECT_DIRECTORY "/config/drives/odrive.yaml"),
              AllOf(HasSubstr("left_wheel_joint: unknown block"), HasSubstr("rear_right_knee_joint.node: missing")));
}

}  // namespace robot_control::tests
