/// Any machine with moving joints is read, whether or not a robot kind drives it.

#include "machine/machine_model.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "machine/quadruped_urdf.h"
#include "support/message_of.h"

namespace robot_control::tests {

std::string refusal_of_machine(const std::string& content) {
  return message_of<RobotError>([&] { read_machine(robot_of(content), {}); }, "accepted");
}

TEST(AMachineOfAnyKind, HasItsJointsInTheOrderOfTheFile) {
  const MachineModel machine = read_machine(robot_of(small_quadruped()), {});
  std::vector<std::string> names;
  for (const JointModel& joint : machine.joints) names.push_back(joint.name);
  std::vector<std::string> expected;
  for (const char* place : {"front_right", "front_left", "rear_right", "rear_left"}) {
    for (const char* part : {"_hip_joint", "_thigh_joint", "_calf_joint"})
      expected.push_back(std::string(place) + part);
  }
  EXPECT_EQ(names, expected);
}

// A turn of three times π in either direction is a limit of a leg, and not the placeholder of a wheel without end.
TEST(AMachineOfAnyKind, HasTheLimitsOfItsActuators) {
  const MachineModel machine = read_machine(robot_of(small_quadruped()), {});
  constexpr double kLower[] = {-0.8, -9.42, -2.7};
  constexpr double kUpper[] = {0.8, 9.42, -0.9};
  for (std::size_t i = 0; i < machine.joints.size(); ++i) {
    const JointModel& joint = machine.joints[i];
    EXPECT_EQ(joint.role, JointRole::kHeld) << joint.name;
    EXPECT_EQ(joint.effort_limit, i % 3 == 2 ? 35 : 20) << joint.name;
    EXPECT_EQ(joint.velocity_limit, i % 3 == 2 ? 20 : 30) << joint.name;
    ASSERT_TRUE(joint.range) << joint.name;
    EXPECT_EQ(joint.range->lower, kLower[i % 3]) << joint.name;
    EXPECT_EQ(joint.range->upper, kUpper[i % 3]) << joint.name;
  }
}

TEST(AMachineOfAnyKind, HasMassesImuAndContacts) {
  const MachineModel machine = read_machine(robot_of(small_quadruped()), {});
  EXPECT_NEAR(machine.mass, 6 + 4 * 1.5, kRounding);
  EXPECT_NEAR(machine.centre_of_gravity_base[0], 0, kRounding);
  EXPECT_NEAR(machine.centre_of_gravity_base[1], 0, kRounding);
  EXPECT_NEAR(machine.centre_of_gravity_base[2], 4 * 0.5 * -0.21 / 12, kRounding) << "of the calves' joints";
  EXPECT_EQ(machine.imu_link, "imu_link");
  EXPECT_EQ(machine.imu_in_base.position, (Vector3{0.1, 0, 0.02}));
  EXPECT_EQ(machine.contacts,
            (std::vector<std::string>{"front_right_calf", "front_left_calf", "rear_right_calf", "rear_left_calf"}));
}

TEST(AMachineOfAnyKind, TakesTheValuesOfTheUser) {
  MachineParameters parameters;
  parameters.mass = 20;
  parameters.imu_position = Vector3{0, 0, 0.1};
  const MachineModel machine = read_machine(robot_of(small_quadruped()), parameters);
  EXPECT_EQ(machine.mass, 20);
  EXPECT_EQ(machine.imu_in_base.position, (Vector3{0, 0, 0.1}));
  EXPECT_NE(machine.hash, read_machine(robot_of(small_quadruped()), {}).hash);
  const auto overridden = [&](const char* element) {
    return std::ranges::count_if(machine.notes, [&](const RobotNote& note) {
      return note.kind == RobotNote::Kind::kOverridden && note.element == element;
    });
  };
  EXPECT_EQ(overridden("robot.mass"), 1);
  EXPECT_EQ(overridden("robot.imu_position"), 1);
}

TEST(AMachineOfAnyKind, IsRefusedByTheWheeledKindAloneWithoutDriveWheels) {
  EXPECT_EQ(refusal_of_machine(small_quadruped()), "accepted");
  const std::string refusal = refusal_of(robot_of(small_quadruped()));
  EXPECT_NE(
      refusal.find("no drive wheels found.\nFound: front_right_hip_joint: its axis is 90° off the lateral (y) axis"),
      std::string::npos)
      << refusal;
  EXPECT_NE(refusal.find("front_right_calf_joint: it turns only from -2.7 to -0.9 rad"), std::string::npos) << refusal;
}

TEST(AMachineOfAnyKind, IsTheMachineOfItsDriveTrainOnWheels) {
  const RobotDescription robot = robot_of(two_wheels());
  const MachineModel machine = read_machine(robot, {});
  const DriveTrain train = read_drive_train(robot, {});
  EXPECT_EQ(machine.mass, train.mass);
  EXPECT_EQ(machine.centre_of_gravity_base, train.centre_of_gravity_base);
  EXPECT_EQ(machine.contacts, train.contacts);
  EXPECT_EQ(machine.contacts, (std::vector<std::string>{"left_link", "right_link"}));
}

TEST(AMachineOfAnyKind, HasAJointThatMoves) {
  EXPECT_NE(refusal_of_machine(base()).find("no joint moves"), std::string::npos);
}

TEST(AMachineOfAnyKind, HasNoMoreJointsThanAFrame) {
  std::string content = base();
  for (int i = 0; i < 33; ++i) content += wheel("joint_" + std::to_string(i), "0 0 0");
  EXPECT_NE(refusal_of_machine(content).find("33 moving joints. Set type=\"fixed\""), std::string::npos);
}

}  // namespace robot_control::tests
