/// Selects the drive wheels by position, shape and axis; by name only if the user names them.

#include "machine/urdf_text.h"
#include "support/matchers.h"

namespace robot_control::tests {

std::string joint_name(const DriveTrain& robot, std::size_t wheel) {
  return robot.joints[robot.wheels[wheel].joint].name;
}

TEST(DriveWheels, ArePlacedLeftThenRight) {
  const DriveTrain robot = read_drive_train(robot_of(two_wheels()), {});
  ASSERT_EQ(robot.wheels.size(), 2u);
  EXPECT_EQ(joint_name(robot, 0), "left");
  EXPECT_EQ(robot.wheels[0].side, Side::kLeft);
  EXPECT_EQ(robot.wheels[1].side, Side::kRight);
  EXPECT_NEAR(robot.wheel_base, 0.5, kRounding);
  EXPECT_EQ(robot.wheel_base_multiplier, 1);
}

TEST(DriveWheels, NamesLiePositionsDoNot) {
  const DriveTrain robot =
      read_drive_train(robot_of(base() + wheel("left", "0 -0.25 0") + wheel("right", "0 0.25 0")), {});
  EXPECT_EQ(joint_name(robot, 0), "right");
  EXPECT_THAT(notes_of(robot, RobotNote::Kind::kSuspicious),
              AllOf(HasSubstr("its name contains right, but it is the left wheel"), HasSubstr("contains left")));
}

// Axis −z under a link turned by +π/2 about x: R_x(π/2)·(0, 0, −1) = (0, 1, 0), forward all the same.
TEST(DriveWheels, SignComesFromTheAxisInTheRootFrame) {
  const std::string turned = joint({.name = "right",
                                    .child = "right_link",
                                    .xyz = "0 -0.25 0",
                                    .axis = "<axis xyz=\"0 0 -1\"/>",
                                    .rpy = "1.5707963267948966 0 0"});
  const std::string upright =
      link("right_link", inertial("1") + collision("<cylinder radius=\"0.1\" length=\"0.04\"/>"));
  EXPECT_EQ(read_drive_train(robot_of(base() + wheel("left", "0 0.25 0") + upright + turned), {}).wheels[1].sign, 1);

  const std::string negated = joint(
      {.name = "right", .child = "right_link", .xyz = "0 -0.25 0", .axis = "<axis xyz=\"0 -1 0\"/>", .rpy = "0 0 0"});
  const std::string link_text = link("right_link", inertial("1") + tyre("0.1"));
  EXPECT_EQ(read_drive_train(robot_of(base() + wheel("left", "0 0.25 0") + link_text + negated), {}).wheels[1].sign,
            -1);
}

// 1.57 for π/2: 0.0008 rad, within 0.2° = 0.0035 rad.
TEST(DriveWheels, AnAxisOffByTheRoundingOfPiIsLateral) {
  const std::string rounded = joint({.name = "right",
                                     .child = "right_link",
                                     .xyz = "0 -0.25 0",
                                     .axis = "<axis xyz=\"0 0 1\"/>",
                                     .rpy = "-1.57 0 0"});
  const std::string upright =
      link("right_link", inertial("1") + collision("<cylinder radius=\"0.1\" length=\"0.04\"/>"));
  EXPECT_EQ(refusal_of(robot_of(base() + wheel("left", "0 0.25 0") + upright + rounded)), "accepted");
}

TEST(DriveWheels, SeparationIsThatOfTheTyresNotOfTheJoints) {
  const auto offset = [](const std::string& name, const std::string& xyz, const std::string& y) {
    return link(name + "_link", inertial("1") + tyre("0.1", y)) +
           joint({.name = name, .child = name + "_link", .xyz = xyz});
  };
  const DriveTrain robot =
      read_drive_train(robot_of(base() + offset("a", "0 0.2 0", "0.03") + offset("b", "0 -0.2 0", "-0.03")), {});
  EXPECT_NEAR(robot.wheel_base, 2 * (0.2 + 0.03), kRounding);
}

TEST(DriveWheels, RadiusIsThatOfTheShapeThatReachesTheFloor) {
  const std::string motor = collision("<cylinder radius=\"0.05\" length=\"0.2\"/>", "rpy=\"1.5707963267948966 0 0\"");
  const auto with_motor = [&](const std::string& name, const std::string& xyz) {
    return link(name + "_link", inertial("1") + motor + tyre("0.1")) +
           joint({.name = name, .child = name + "_link", .xyz = xyz});
  };
  const DriveTrain robot =
      read_drive_train(robot_of(base() + with_motor("left", "0 0.25 0") + with_motor("right", "0 -0.25 0")), {});
  EXPECT_EQ(robot.wheels[0].radius, 0.1);
  EXPECT_NEAR(robot.wheels[0].width, 0.04, kRounding);
}

// Two axles L apart: mean xᵢ² = L²/4, so 1 + (L/b)² = 1 + (0.3/0.5)².
TEST(DriveWheels, TwoPairsSteerBySkidding) {
  const DriveTrain robot = read_drive_train(
      robot_of(two_wheels() + wheel("rear_left", "-0.3 0.25 0") + wheel("rear_right", "-0.3 -0.25 0")), {});
  ASSERT_EQ(robot.wheels.size(), 4u);
  EXPECT_EQ(joint_name(robot, 0), "left");
  EXPECT_EQ(joint_name(robot, 1), "rear_left");
  EXPECT_EQ(joint_name(robot, 3), "rear_right");
  EXPECT_NEAR(robot.wheel_base_multiplier, 1 + 0.6 * 0.6, kRounding);
  EXPECT_THAT(notes_of(robot, RobotNote::Kind::kAssumed), HasSubstr("wheel_base_multiplier: 1.36"));
  DriveTrainParameters parameters;
  parameters.wheel_base_multiplier = 1.5;
  EXPECT_EQ(read_drive_train(robot_of(robot.urdf.substr(16, robot.urdf.size() - 24)), parameters).wheel_base_multiplier,
            1.5);
}

// Like TwoPairsSteerBySkidding, but the URDF says which two are driven: the others roll along.
TEST(DriveWheels, DrivenOnesDriveTheOthersRollAlong) {
  const DriveTrain robot =
      read_drive_train(robot_of(two_wheels() + wheel("rear_left", "-0.3 0.25 0") + wheel("rear_right", "-0.3 -0.25 0") +
                                transmission("left") + transmission("right")),
                       {});
  ASSERT_EQ(robot.wheels.size(), 2u);
  ASSERT_EQ(robot.casters.size(), 2u);
  EXPECT_EQ(robot.joints[2].role, JointRole::kPassive);
  EXPECT_EQ(robot.joints[robot.casters[0].joint].name, "rear_left");
}

TEST(DriveWheels, ADrivePluginOrRos2ControlNamesThemAsWell) {
  const std::string four = two_wheels() + wheel("rear_left", "-0.3 0.25 0") + wheel("rear_right", "-0.3 -0.25 0");
  const std::string plugin =
      "<gazebo><plugin filename=\"libgazebo_ros_diff_drive.so\"><leftJoint>right</leftJoint><rightJoint> left "
      "</rightJoint></plugin></gazebo>";
  const auto command = [](const std::string& name) {
    return "<ros2_control><joint name=\"" + name + "\"><command_interface name=\"velocity\"/></joint></ros2_control>";
  };
  EXPECT_EQ(read_drive_train(robot_of(four + plugin), {}).wheels.size(), 2u);
  EXPECT_EQ(read_drive_train(robot_of(four + command("left") + command("right")), {}).wheels.size(), 2u);
}

TEST(DriveWheels, ASwivellingCasterIsNone) {
  const std::string swivel =
      link("fork", inertial("0.2")) +
      joint({.name = "swivel", .child = "fork", .xyz = "-0.3 0.1 0", .axis = "<axis xyz=\"0 0 1\"/>"}) +
      link("roller", inertial("0.2") + tyre("0.1")) +
      joint({.name = "caster_wheel", .child = "roller", .xyz = "-0.03 0 0", .parent = "fork"});
  const DriveTrain robot = read_drive_train(robot_of(two_wheels() + swivel + transmission("caster_wheel")), {});
  EXPECT_EQ(robot.wheels.size(), 2u);
  ASSERT_EQ(robot.casters.size(), 1u);
  for (const JointModel& each : robot.joints) {
    if (each.name == "swivel" || each.name == "caster_wheel") {
      EXPECT_EQ(each.role, JointRole::kPassive);
    }
  }
}

TEST(DriveWheels, AWheelOnTheMiddleLineIsACaster) {
  const DriveTrain robot = read_drive_train(robot_of(two_wheels() + wheel("rear", "-0.3 0 0")), {});
  EXPECT_EQ(robot.wheels.size(), 2u);
  EXPECT_EQ(robot.casters.size(), 1u);
}

TEST(DriveWheels, WhatTurnsHighAboveTheFloorIsNone) {
  const DriveTrain robot = read_drive_train(
      robot_of(two_wheels() + wheel("pulley_left", "0 0.2 0.3") + wheel("pulley_right", "0 -0.2 0.3")), {});
  EXPECT_EQ(robot.wheels.size(), 2u);
  EXPECT_TRUE(robot.casters.empty());
}

TEST(DriveWheels, NamedOnesHoldWhateverElseRolls) {
  DriveTrainParameters parameters;
  parameters.left_wheel_joints = {"rear_left"};
  parameters.right_wheel_joints = {"rear_right"};
  const DriveTrain robot = read_drive_train(robot_of(two_wheels() + wheel("rear_left", "-0.3 0.25 -0.02", "0.08") +
                                                     wheel("rear_right", "-0.3 -0.25 -0.02", "0.08")),
                                            parameters);
  ASSERT_EQ(robot.wheels.size(), 2u);
  EXPECT_EQ(joint_name(robot, 0), "rear_left");
  EXPECT_EQ(robot.wheels[0].radius, 0.08);
  EXPECT_EQ(robot.casters.size(), 2u);
}

TEST(DriveWheels, ARobotWhoseMiddleIsBesideItsRootIsTakenAsItStands) {
  const DriveTrain robot =
      read_drive_train(robot_of(base() + wheel("left", "0 0.35 0") + wheel("right", "0 -0.15 0")), {});
  EXPECT_NEAR(robot.wheel_base, 0.5, kRounding);
}

TEST(DriveWheels, PairsOfTwoRadiiAreNotGuessed) {
  EXPECT_THAT(refusal_of(robot_of(two_wheels() + wheel("rear_left", "-0.3 0.25 -0.02", "0.08") +
                                  wheel("rear_right", "-0.3 -0.25 -0.02", "0.08"))),
              AllOf(HasSubstr("r.urdf: <robot>"), HasSubstr("radii differ"), HasSubstr("rear_left (x -0.3 m"),
                    HasSubstr("Fix: Set one radius")));
}

TEST(DriveWheels, SmallerWheelsLevelWithTheDriveWheelsAreNotOverlooked) {
  EXPECT_THAT(refusal_of(robot_of(two_wheels() + wheel("rear_left", "-0.3 0.25 0", "0.08") +
                                  wheel("rear_right", "-0.3 -0.25 0", "0.08"))),
              AllOf(HasSubstr("radii differ"), HasSubstr("rear_left (x -0.3 m")));
}

TEST(DriveWheels, AWheelWithoutItsCounterpartIsNotGuessed) {
  EXPECT_THAT(refusal_of(robot_of(base() + wheel("left", "0 0.25 0"))),
              AllOf(HasSubstr("there is only one. Candidates: left (x 0 m"), HasSubstr("robot.left_wheel_joints")));
  EXPECT_THAT(refusal_of(robot_of(two_wheels() + wheel("third", "-0.3 0.25 0"))),
              HasSubstr("2 wheels are on the left, 1 on"));
}

TEST(DriveWheels, EachReasonIsReportedWithoutWheels) {
  const std::string fixed = link("f", inertial("1") + tyre("0.1")) +
                            joint({.name = "fixed_wheel", .child = "f", .xyz = "0 0.25 0", .type = "fixed"});
  const std::string forward = link("x", inertial("1") + tyre("0.1")) +
                              joint({.name = "x_wheel", .child = "x", .axis = "<axis xyz=\"1 0 0\"/>"});
  const std::string misspelt = link("m", inertial("1") + tyre("0.1")) +
                               joint({.name = "m_wheel", .child = "m", .axis = "<axis xzy=\"0 1 0\"/>"});
  const std::string square =
      link("s", inertial("1") + collision("<box size=\"0.2 0.2 0.2\"/>")) + joint({.name = "s_wheel", .child = "s"});
  EXPECT_THAT(refusal_of(robot_of(base() + fixed + forward + misspelt + square)),
              AllOf(HasSubstr("fixed_wheel: it is type=\"fixed\""), HasSubstr("x_wheel: its axis is 90° off"),
                    HasSubstr("m_wheel: its axis is 90° off the lateral (y) axis of base_link, allowed is 0.2° (it "
                              "has no <axis xyz"),
                    HasSubstr("s_wheel: its shape is not round")));
}

TEST(DriveWheels, TracksAreRefused) {
  std::string track = base();
  for (int i = 0; i < 5; ++i) {
    const std::string x = std::to_string(i * 0.2);
    track += wheel("left_" + std::to_string(i), x + " 0.25 0") + wheel("right_" + std::to_string(i), x + " -0.25 0");
  }
  EXPECT_THAT(refusal_of(robot_of(track)), AllOf(HasSubstr("which of 10 wheels"), HasSubstr("tracks")));
}

TEST(DriveWheels, NamesOnOneSideOnlyAreRefused) {
  DriveTrainParameters parameters;
  parameters.left_wheel_joints = {"left"};
  EXPECT_THAT(refusal_of(robot_of(two_wheels()), parameters), HasSubstr("the numbers of joints differ"));
}

TEST(DriveWheels, NamedRadiiThatDifferByMoreThanOnePercentAreRefused) {
  DriveTrainParameters parameters;
  parameters.left_wheel_joints = {"left", "rear_left"};
  parameters.right_wheel_joints = {"right", "rear_right"};
  const auto with_rear = [&](const std::string& radius) {
    return refusal_of(robot_of(two_wheels() + wheel("rear_left", "-0.3 0.25 0", radius) +
                               wheel("rear_right", "-0.3 -0.25 0", radius)),
                      parameters);
  };
  EXPECT_THAT(with_rear("0.102"), AllOf(HasSubstr("radii differ"), HasSubstr("radius 0.102 m")));
  EXPECT_EQ(with_rear("0.1009"), "accepted");
}

TEST(DriveWheels, AlmostOneRadiusOnEitherSideIsOneRadius) {
  EXPECT_EQ(refusal_of(robot_of(base() + wheel("left", "0 0.25 0", "0.1001") + wheel("right", "0 -0.25 0"))),
            "accepted");
}

}  // namespace robot_control::tests
