/// The motors of a machine are its driven joints, which come first, each with the brake of the robot's kind.

#include "drivers/drive_motors.h"

#include "drivers/driver.h"
#include "support/matchers.h"
#include "support/message_of.h"

namespace robot_control::tests {

MachineModel machine(std::initializer_list<JointRole> roles) {
  MachineModel model;
  for (const JointRole role : roles)
    model.joints.push_back(
        {.name = "joint " + std::to_string(model.joints.size()), .child_link = "", .effort_limit = 3, .role = role});
  return model;
}

std::string refusal(const MachineModel& model, std::size_t brakes) {
  return message_of<DriverError>([&] { drive_motors(model, std::vector<Brake>(brakes)); });
}

TEST(DriveMotors, AreTheDrivenJointsOfAMachine) {
  using enum JointRole;
  const DriveMotors motors = drive_motors(machine({kDriven, kDriven, kPassive, kHeld}), std::vector<Brake>(2));
  EXPECT_THAT(motors.joints, ElementsAre("joint 0", "joint 1"));
  EXPECT_THAT(motors.effort_limits, ElementsAre(3, 3));
  EXPECT_EQ(motors.joint_count, 4u);
}

TEST(DriveMotors, RefuseAKindWithoutBrakes) {
  EXPECT_THAT(refusal(machine({JointRole::kDriven}), 0), HasSubstr("set robot.driver to mujoco"));
}

/// A driver moves the first joints: torque would reach another motor.
TEST(DriveMotors, RefuseADrivenJointBehindAnother) {
  using enum JointRole;
  EXPECT_THAT(refusal(machine({kDriven, kPassive, kDriven}), 2), HasSubstr("'joint 1' is not driven"));
}

}  // namespace robot_control::tests
