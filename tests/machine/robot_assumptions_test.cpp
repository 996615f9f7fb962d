/// A URDF omits or misstates values; the reader replaces them, and each replacement is noted.

#include <Eigen/Eigenvalues>
#include <cmath>

#include "machine/bodies/link_inertia.h"
#include "machine/bodies/rigid_bodies.h"
#include "machine/urdf_text.h"
#include "support/matchers.h"

namespace robot_control::tests {

const JointModel& joint_of(const DriveTrain& robot, const std::string& name) {
  for (const JointModel& each : robot.joints) {
    if (each.name == name) return each;
  }
  throw std::logic_error(name);
}

std::string assumed(const DriveTrain& robot) {
  return notes_of(robot, RobotNote::Kind::kAssumed);
}

DriveTrain with_limit(const std::string& limit) {
  return read_drive_train(
      robot_of(base() + wheel("left", "0 0.25 0", "0.1", limit) + wheel("right", "0 -0.25 0", "0.1", limit)), {});
}

constexpr double kGrip = (10 + 1 + 1) * 9.81 / 2 * 0.1;  // μ m g / n · r with μ = 1

TEST(RobotAssumptions, ALinkWithoutInertialHasNoMass) {
  const std::string plate = link("plate", collision("<box size=\"1 1 1\"/>")) +
                            joint({.name = "plate_joint", .child = "plate", .type = "fixed"});
  EXPECT_NEAR(read_drive_train(robot_of(two_wheels() + plate), {}).mass, 12, kRounding);
}

TEST(RobotAssumptions, AnUnknownEffortIsWhatTheTyreTransmits) {
  for (const std::string limit :
       {"", "<limit effort=\"0\" velocity=\"0\"/>", "<limit effort=\"100\" velocity=\"100\"/>",
        "<limit effort=\"1000\" velocity=\"1000\"/>"}) {
    const DriveTrain robot = with_limit(limit);
    EXPECT_NEAR(robot.joints[0].effort_limit, kGrip, kRounding) << limit;
    EXPECT_EQ(robot.joints[0].velocity_limit, 0) << limit;
    EXPECT_THAT(assumed(robot), HasSubstr("5.886 N·m")) << limit;
  }
}

TEST(RobotAssumptions, ALimitWithOneOfTheTwoNumbersIsRead) {
  EXPECT_EQ(with_limit("<limit effort=\"3\"/>").joints[0].effort_limit, 3);
  EXPECT_EQ(with_limit("<limit velocity=\"9\"/>").joints[0].velocity_limit, 9);
}

TEST(RobotAssumptions, CredibleLimitsHold) {
  const DriveTrain robot = with_limit("<limit effort=\"3\" velocity=\"1.0\"/>");
  EXPECT_EQ(robot.joints[0].effort_limit, 3);
  EXPECT_EQ(robot.joints[0].velocity_limit, 1);
  EXPECT_THAT(assumed(robot), Not(HasSubstr("limit")));
}

TEST(RobotAssumptions, OverridesOfTheLimitsHold) {
  DriveTrainParameters parameters;
  parameters.wheel_effort_limit = 2;
  parameters.wheel_velocity_limit = 7;
  const DriveTrain robot = read_drive_train(robot_of(two_wheels()), parameters);
  EXPECT_EQ(robot.joints[1].effort_limit, 2);
  EXPECT_EQ(robot.joints[1].velocity_limit, 7);
  EXPECT_THAT(assumed(robot), Not(HasSubstr("effort")));
}

// A wheel of 10 g cm²: 1e-6 kg·m². The floor is 5 % of the robot's share: 0.05 · 12/2 · 0.1² = 0.003.
TEST(RobotAssumptions, AWheelWithoutARotorGetsOne) {
  const std::string light = "ixx=\"1e-6\" iyy=\"1e-6\" izz=\"1e-6\" ixy=\"0\" ixz=\"0\" iyz=\"0\"";
  const auto printed = [&](const std::string& name, const std::string& xyz) {
    return link(name + "_link", inertial("1", light) + tyre("0.1")) +
           joint({.name = name, .child = name + "_link", .xyz = xyz});
  };
  const DriveTrain robot =
      read_drive_train(robot_of(base() + printed("left", "0 0.25 0") + printed("right", "0 -0.25 0")), {});
  EXPECT_NEAR(robot.wheels[0].inertia, 0.003, kRounding);
  EXPECT_NEAR(robot.wheels[0].rotor_inertia, 0.003 - 1e-6, kRounding);
  EXPECT_THAT(assumed(robot), HasSubstr("rotor inertia"));
  EXPECT_EQ(read_drive_train(robot_of(two_wheels()), {}).wheels[0].rotor_inertia, 0);
}

// 0.01, 0.01, 0.5 (create_2): A and B grow by ((1 + ε) 0.5 − 0.02)/2.
TEST(RobotAssumptions, ABrokenTriangleIsClosedFromBelow) {
  const Eigen::Matrix3d given = Eigen::Vector3d(0.01, 0.01, 0.5).asDiagonal();
  const Eigen::Matrix3d expected = Eigen::Vector3d(0.25 * (1 + kThickness), 0.25 * (1 + kThickness), 0.5).asDiagonal();
  EXPECT_NEAR((possible_inertia(given, 2) - expected).norm(), 0, kRounding);
}

TEST(RobotAssumptions, ZeroInertiaIsThatOfABall) {
  const Eigen::Matrix3d ball = possible_inertia(Eigen::Matrix3d::Zero(), 2);
  EXPECT_NEAR((ball - 0.4 * 2 * kBallRadius * kBallRadius * Eigen::Matrix3d::Identity()).norm(), 0, kRounding);
}

TEST(RobotAssumptions, APossibleInertiaStaysBitForBit) {
  Eigen::Matrix3d given;
  given << 0.3, 0.01, -0.02, 0.01, 0.4, 0.03, -0.02, 0.03, 0.5;
  EXPECT_EQ(possible_inertia(given, 3), given);
}

TEST(RobotAssumptions, TheRepairedInertiaIsOneOfABodyWhateverIsGiven) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    std::srand(seed);
    Eigen::Matrix3d given = Eigen::Matrix3d::Random();
    given = (given + given.transpose()).eval();
    const Eigen::Vector3d p = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(possible_inertia(given, 1)).eigenvalues();
    EXPECT_GT(p[0], 0) << "seed " << seed;
    EXPECT_GE(p[0] + p[1], p[2] * (1 - 1e-8)) << "seed " << seed;
  }
}

TEST(RobotAssumptions, ARepairKeepsTheMassAndNamesTheNumbers) {
  const std::string flat = "ixx=\"0.01\" iyy=\"0.01\" izz=\"0.5\" ixy=\"0\" ixz=\"0\" iyz=\"0\"";
  const std::string disc =
      link("disc", inertial("2", flat)) + joint({.name = "disc_joint", .child = "disc", .type = "fixed"});
  const DriveTrain robot = read_drive_train(robot_of(two_wheels() + disc), {});
  EXPECT_NEAR(robot.mass, 14, kRounding);
  EXPECT_THAT(notes_of(robot, RobotNote::Kind::kRepaired),
              AllOf(HasSubstr("<link name=\"disc\">"), HasSubstr("0.01, 0.01, 0.5"), HasSubstr("0.25, 0.25, 0.5")));
}

// √(1e-3/0.01) = 0.32 m in a ball of 18 mm (kobuki's caster).
TEST(RobotAssumptions, AnInertiaLargerThanThePartIsNotedAndKept) {
  const std::string huge = "ixx=\"0.001\" iyy=\"0.001\" izz=\"0.001\" ixy=\"0\" ixz=\"0\" iyz=\"0\"";
  const std::string ball = link("ball", inertial("0.01", huge) + collision("<sphere radius=\"0.018\"/>")) +
                           joint({.name = "ball_joint", .child = "ball", .type = "fixed"});
  EXPECT_THAT(notes_of(read_drive_train(robot_of(two_wheels() + ball), {}), RobotNote::Kind::kSuspicious),
              HasSubstr("radius of gyration is 0.316228 m"));
}

TEST(RobotAssumptions, AMovingBodyWithoutInertialOnWhichNothingRollsIsWelded) {
  const std::string lift =
      link("lift", "") + joint({.name = "lift_joint",
                                .child = "lift",
                                .type = "prismatic",
                                .axis = "<axis xyz=\"0 0 1\"/>",
                                .rest = "<limit lower=\"0\" upper=\"1\" effort=\"10\" velocity=\"1\"/>"});
  const DriveTrain robot = read_drive_train(robot_of(two_wheels() + lift), {});
  EXPECT_EQ(robot.joints.size(), 2u);
  EXPECT_EQ(robot.bodies->joints.at("lift_joint"), JointType::kFixed);
  EXPECT_EQ(robot.bodies->links.at("lift").body, 0u);
  EXPECT_THAT(assumed(robot), HasSubstr("lift_joint"));
}

// 1 % of 10 kg each; a solid cylinder: m/2 r² = 0.1/2 · 0.1² about its axle.
TEST(RobotAssumptions, AWheelWithoutInertialTakesItsMassFromTheBase) {
  const auto hollow = [](const std::string& name, const std::string& xyz) {
    return link(name + "_link", tyre("0.1")) + joint({.name = name, .child = name + "_link", .xyz = xyz});
  };
  const DriveTrain robot =
      read_drive_train(robot_of(base() + hollow("left", "0 0.25 0") + hollow("right", "0 -0.25 0")), {});
  EXPECT_NEAR(robot.mass, 10, kRounding);
  const RigidBody& left = *robot.bodies->moved_by("left");
  EXPECT_NEAR(left.mass, 0.1, kRounding);
  EXPECT_NEAR(left.joint.axis.dot(left.inertia * left.joint.axis), 0.1 / 2 * 0.01, kRounding);
  EXPECT_THAT(assumed(robot), HasSubstr("taken from \"base_link\""));
}

TEST(RobotAssumptions, TheVisualShapesCountWithoutAnyCollision) {
  std::string text = robot_of(two_wheels()).text;
  for (std::size_t at = text.find("collision"); at != std::string::npos; at = text.find("collision")) {
    text.replace(at, 9, "visual");
  }
  const DriveTrain robot = read_drive_train({text, "r.urdf"}, {});
  EXPECT_EQ(robot.wheels[0].radius, 0.1);
  EXPECT_EQ(robot.bodies->bodies[0].shapes.size(), 1u);
  EXPECT_THAT(assumed(robot), HasSubstr("<visual> shapes are used"));
}

TEST(RobotAssumptions, AWheelWithoutCollisionHasItsVisualShape) {
  std::string text = robot_of(two_wheels()).text;
  for (const std::string tag : {"<collision>", "</collision>"}) {
    const std::size_t at = text.find(tag, text.find("left_link"));
    text.replace(at + tag.find("collision"), 9, "visual");
  }
  const DriveTrain robot = read_drive_train({text, "r.urdf"}, {});
  EXPECT_EQ(robot.wheels[0].radius, 0.1);
  EXPECT_THAT(assumed(robot), HasSubstr("<link name=\"left_link\">: no <collision>"));
}

// Each carries half of what is above: 10/2 kg. k = m ω², c = 2 m ω with ω = 2π · 5 Hz. The axis points up, so the
// spring, which pushes the wheel down, has a negative load.
TEST(RobotAssumptions, ASuspendedWheelGetsASpring) {
  const auto suspended = [](const std::string& name, const std::string& xyz) {
    return link(name + "_slider", inertial("1")) +
           joint({.name = name + "_slide",
                  .child = name + "_slider",
                  .xyz = xyz,
                  .type = "prismatic",
                  .axis = "<axis xyz=\"0 0 1\"/>",
                  .rest = "<limit lower=\"-0.01\" upper=\"0.01\" effort=\"100\" velocity=\"1\"/>"}) +
           link(name + "_link", inertial("1") + tyre("0.1")) +
           joint({.name = name, .child = name + "_link", .parent = name + "_slider"});
  };
  const DriveTrain robot =
      read_drive_train(robot_of(base() + suspended("left", "0 0.25 0") + suspended("right", "0 -0.25 0")), {});
  const BodyJoint& spring = robot.bodies->moved_by("left_slide")->joint;
  const double omega = 2 * M_PI * 5;
  EXPECT_NEAR(spring.spring_load, -5 * 9.81, 1e-9);
  EXPECT_NEAR(spring.spring_stiffness, 5 * omega * omega, 1e-9);
  EXPECT_NEAR(spring.damping, 2 * 5 * omega, 1e-9);
  EXPECT_EQ(joint_of(robot, "left_slide").role, JointRole::kPassive);
  EXPECT_EQ(joint_of(robot, "left_slide").effort_limit, 0);
}

TEST(RobotAssumptions, AnArmIsHeldAFollowerAndAJointWithoutEffortAreNot) {
  const auto arm = [](const std::string& name, const std::string& rest) {
    return link(name + "_link", inertial("1")) + joint({.name = name,
                                                        .child = name + "_link",
                                                        .type = "revolute",
                                                        .axis = "<axis xyz=\"0 0 1\"/>",
                                                        .rest = rest});
  };
  const DriveTrain robot = read_drive_train(
      robot_of(two_wheels() + arm("shoulder", "<limit lower=\"-1\" upper=\"1\" effort=\"9\" velocity=\"1\"/>") +
               arm("twin",
                   "<limit lower=\"-1\" upper=\"1\" effort=\"9\" velocity=\"1\"/><mimic joint=\"shoulder\" "
                   "multiplier=\"-2\" offset=\"0.1\"/>") +
               arm("loose", "<limit lower=\"-1\" upper=\"1\" effort=\"0\" velocity=\"0\"/>")),
      {});
  EXPECT_EQ(joint_of(robot, "shoulder").role, JointRole::kHeld);
  EXPECT_EQ(joint_of(robot, "shoulder").effort_limit, 9);
  EXPECT_EQ(joint_of(robot, "twin").role, JointRole::kPassive);
  EXPECT_EQ(joint_of(robot, "loose").role, JointRole::kPassive);
  const BodyJoint& twin = robot.bodies->moved_by("twin")->joint;
  EXPECT_EQ(twin.mimicked, "shoulder");
  EXPECT_EQ(twin.mimic_multiplier, -2);
  EXPECT_EQ(twin.mimic_offset, 0.1);
}

TEST(RobotAssumptions, TheImuIsFoundByAWordOfItsName) {
  const auto fixed = [](const std::string& name) {
    return link(name, "") + joint({.name = name + "_joint", .child = name, .type = "fixed"});
  };
  EXPECT_EQ(read_drive_train(robot_of(two_wheels() + fixed("base_imu_link")), {}).imu_link, "base_imu_link");
  EXPECT_EQ(read_drive_train(robot_of(two_wheels() + fixed("gyro_link")), {}).imu_link, "gyro_link");
  EXPECT_EQ(read_drive_train(robot_of(two_wheels() + fixed("simulated_part")), {}).imu_link, "");
  DriveTrainParameters parameters;
  parameters.imu_link = "box";
  EXPECT_EQ(read_drive_train(robot_of(two_wheels() + fixed("gyro_link") + fixed("box")), parameters).imu_link, "box");
  parameters.imu_link = "nowhere";
  EXPECT_THAT(refusal_of(robot_of(two_wheels()), parameters), HasSubstr("no link \"nowhere\""));
}

TEST(NegativeNumbers, AreTakenAsNotGivenAndNoted) {
  for (const std::string rest : {"<limit effort=\"-5\" velocity=\"9\"/>", "<limit effort=\"5\" velocity=\"-9\"/>",
                                 "<dynamics damping=\"-5\"/>", "<dynamics friction=\"-5\"/>"}) {
    const std::string text = base() + wheel("left", "0 0.25 0", "0.1", rest) + wheel("right", "0 -0.25 0");
    EXPECT_THAT(notes_of(read_drive_train(robot_of(text), {}), RobotNote::Kind::kSuspicious), HasSubstr("is negative"))
        << rest;
  }
}

}  // namespace robot_control::tests
