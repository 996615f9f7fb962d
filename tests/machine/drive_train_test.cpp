#include "machine/wheeled/drive_train.h"

#include <gtest/gtest.h>

#include <cmath>

#include "machine/bodies/rigid_bodies.h"
#include "machine/urdf_text.h"
#include "support/robots/diffbot_urdf.h"

namespace robot_control::tests {

// Decimal numbers of the file, a few dozen operations: rounding only.

const std::string kLeftJoint = "<joint name=\"left_wheel_joint\"";
const std::string kRightJoint = "<joint name=\"right_wheel_joint\"";

TEST(DriveTrain, TotalMassIsTheSumOfAllLinks) {
  EXPECT_NEAR(read_drive_train(diffbot_urdf(), {}).mass, 6.0 + 3.45 + 1.0 + 1.0 + 0.5 + 0.05, kRounding);
}

TEST(DriveTrain, CentreOfGravityIsTheMassWeightedMean) {
  const DriveTrain robot = read_drive_train(diffbot_urdf(), {});
  EXPECT_NEAR(robot.centre_of_gravity_base[0], (6 * -0.08 + 3.45 * -0.035 + 0.5 * -0.25 + 0.05 * 0.05) / 12, kRounding);
  EXPECT_NEAR(robot.centre_of_gravity_base[1], 0.05 * 0.02 / 12, kRounding);
  EXPECT_NEAR(robot.centre_of_gravity_base[2], (3.45 * -0.03 + 0.5 * -0.06 + 0.05 * 0.06) / 12, kRounding);
}

TEST(DriveTrain, YawInertiaIsTakenAboutTheMiddleOfTheAxle) {
  const double chassis = 0.1448 + 6 * 0.08 * 0.08;
  const double battery = 0.013455 + 3.45 * 0.035 * 0.035;
  const double wheels = 2 * (0.002633 + 0.25 * 0.25);
  const double caster = 0.00032 + 0.5 * 0.25 * 0.25;
  const double imu = 0.00001 + 0.05 * (0.05 * 0.05 + 0.02 * 0.02);
  EXPECT_NEAR(read_drive_train(diffbot_urdf(), {}).yaw_inertia, chassis + battery + wheels + caster + imu, kRounding);
}

TEST(DriveTrain, FullTorqueTipsItNeitherWay) {
  const DriveTrain robot = read_drive_train(diffbot_urdf(), {});
  const double acceleration = 2 * robot.joints[0].effort_limit / robot.wheels[0].radius / robot.mass;
  const double height = robot.centre_of_gravity_base[2] + robot.wheels[0].radius;
  const double behind_axle = -robot.centre_of_gravity_base[0];
  EXPECT_LT(acceleration * height, 9.81 * behind_axle);
  EXPECT_LT(acceleration * height, 9.81 * (0.25 - behind_axle));
}

TEST(DriveTrain, WheelsAreMeasuredAtTheirCollisionCylinders) {
  const DriveTrain robot = read_drive_train(diffbot_urdf(), {});
  EXPECT_NEAR(robot.wheel_base, 0.5, kRounding);
  for (const WheelModel* wheel : {&robot.wheels[0], &robot.wheels[1]}) {
    EXPECT_EQ(wheel->radius, 0.1);
    EXPECT_EQ(wheel->width, 0.04);
    EXPECT_EQ(wheel->sign, 1);
    EXPECT_NEAR(wheel->inertia, 0.005, kRounding);
  }
  EXPECT_NEAR(robot.wheels[0].centre_base[1], 0.25, kRounding);
  EXPECT_NEAR(robot.wheels[1].centre_base[1], -0.25, kRounding);
}

TEST(DriveTrain, WheelsComeFirstInTheOrderOfJoints) {
  const std::string arm =
      link("a", inertial("1")) + joint({.name = "a_joint", .child = "a", .axis = "<axis xyz=\"0 0 1\"/>"});
  const DriveTrain robot =
      read_drive_train(diffbot_with("<robot", "<link name=\"base_link\">", arm + "<link name=\"base_link\">"), {});
  ASSERT_EQ(robot.joints.size(), 3u);
  EXPECT_EQ(robot.joints[0].name, "left_wheel_joint");
  EXPECT_EQ(robot.joints[1].name, "right_wheel_joint");
  EXPECT_EQ(robot.joints[2].name, "a_joint");
  EXPECT_EQ(robot.joints[0].child_link, "left_wheel_link");
  EXPECT_EQ(robot.joints[0].effort_limit, 3.5);
  EXPECT_EQ(robot.joints[0].velocity_limit, 30);
}

TEST(DriveTrain, AMirroredAxisTurnsTheSign) {
  const DriveTrain robot =
      read_drive_train(diffbot_with(kRightJoint, "<axis xyz=\"0 1 0\"/>", "<axis xyz=\"0 -1 0\"/>"), {});
  EXPECT_EQ(robot.wheels[0].sign, 1);
  EXPECT_EQ(robot.wheels[1].sign, -1);
}

// The common way to draw a wheel: the link's z is the axle, the joint turns it there.
TEST(DriveTrain, AnAxisTurnedByTheJointsOriginIsTheSameWheel) {
  RobotDescription description = diffbot_with(kLeftJoint, "<origin xyz=\"0 0.25 0\"/>",
                                              "<origin xyz=\"0 0.25 0\" rpy=\"-1.5707963267948966 0 0\"/>");
  description.text = replaced(description.text, kLeftJoint, "<axis xyz=\"0 1 0\"/>", "<axis xyz=\"0 0 1\"/>");
  description.text = replaced(description.text, "<link name=\"left_wheel_link\">",
                              "iyy=\"0.005\" iyz=\"0\" izz=\"0.002633\"", "iyy=\"0.002633\" iyz=\"0\" izz=\"0.005\"");
  description.text = replaced(description.text, "<link name=\"left_wheel_link\">",
                              "<collision>\n      <origin rpy=\"1.5707963267948966 0 0\"/>", "<collision>");
  const DriveTrain robot = read_drive_train(description, {});
  EXPECT_EQ(robot.wheels[0].sign, 1);
  EXPECT_EQ(robot.wheels[0].radius, 0.1);
  EXPECT_NEAR(robot.wheels[0].inertia, 0.005, kRounding);
  EXPECT_NEAR(robot.wheel_base, 0.5, kRounding);
  EXPECT_NEAR(robot.mass, 12, kRounding);
}

TEST(DriveTrain, ASphereIsAWheelToo) {
  const DriveTrain robot =
      read_drive_train(diffbot_with("<link name=\"left_wheel_link\">",
                                    "</visual>\n    <collision>\n      <origin rpy=\"1.5707963267948966 0 0\"/>\n      "
                                    "<geometry><cylinder radius=\"0.1\" length=\"0.04\"/>",
                                    "</visual><collision><geometry><sphere radius=\"0.1\"/>"),
                       {});
  EXPECT_EQ(robot.wheels[0].radius, 0.1);
}

TEST(DriveTrain, EffectiveWheelBaseAndRadiusOverrideTheUrdf) {
  DriveTrainParameters parameters;
  parameters.wheel_base = 0.51;
  parameters.wheel_radius = 0.099;
  const DriveTrain robot = read_drive_train(diffbot_urdf(), parameters);
  EXPECT_EQ(robot.wheel_base, 0.51);
  EXPECT_EQ(robot.wheels[0].radius, 0.099);
  EXPECT_EQ(robot.wheels[1].radius, 0.099);
}

// The base and the wheels' 12 kg, doubled: the yaw inertia about the same centre of gravity doubles, too.
TEST(DriveTrain, AnotherMassReplacesTheUrdfs) {
  const DriveTrain urdf = read_drive_train(diffbot_urdf(), {});
  DriveTrainParameters parameters;
  parameters.mass = 24;
  const DriveTrain robot = read_drive_train(diffbot_urdf(), parameters);
  EXPECT_EQ(robot.mass, 24);
  EXPECT_NEAR(robot.yaw_inertia, 2 * urdf.yaw_inertia, kRounding);
  EXPECT_NEAR(total_mass(*robot.bodies), 12, kRounding);
}

// Steiner: moved to the middle of the axle, the robot loses m d².
TEST(DriveTrain, AnotherCentreOfGravityReplacesTheUrdfs) {
  const DriveTrain urdf = read_drive_train(diffbot_urdf(), {});
  DriveTrainParameters parameters;
  parameters.centre_of_gravity = Vector3{0, 0, 0.02};
  const DriveTrain robot = read_drive_train(diffbot_urdf(), parameters);
  EXPECT_EQ(robot.centre_of_gravity_base, (Vector3{0, 0, 0.02}));
  const auto& c = urdf.centre_of_gravity_base;
  EXPECT_NEAR(robot.yaw_inertia, urdf.yaw_inertia - 12 * (c[0] * c[0] + c[1] * c[1]), kRounding);
}

TEST(DriveTrain, OverridesBeyondOnePercentAreNotedOnce) {
  DriveTrainParameters parameters;
  parameters.wheel_base = 0.504;
  parameters.wheel_radius = 0.102;
  parameters.mass = 13;
  std::vector<std::string> noted;
  for (const RobotNote& note : read_drive_train(diffbot_urdf(), parameters).notes) {
    if (note.kind == RobotNote::Kind::kOverridden) noted.push_back(note.element);
  }
  EXPECT_EQ(noted, (std::vector<std::string>{"robot.wheel_radius", "robot.mass"}));
}

TEST(DriveTrain, RadiusMultipliersApplyToTheWheelsOfTheirSide) {
  DriveTrainParameters parameters;
  parameters.wheel_radius = 0.11;
  parameters.left_wheel_radius_multiplier = 1.02;
  parameters.right_wheel_radius_multiplier = 0.97;
  const DriveTrain robot = read_drive_train(diffbot_urdf(), parameters);
  EXPECT_NEAR(robot.wheels[0].radius, 0.11 * 1.02, kRounding);
  EXPECT_NEAR(robot.wheels[1].radius, 0.11 * 0.97, kRounding);
  EXPECT_NE(robot.hash, read_drive_train(diffbot_urdf(), {}).hash);
}

TEST(DriveTrain, TheBodiesAreThoseOfTheFile) {
  const DriveTrain robot = read_drive_train(diffbot_urdf(), {});
  ASSERT_NE(robot.bodies, nullptr);
  EXPECT_EQ(robot.bodies->bodies.size(), 3u);
  EXPECT_EQ(robot.bodies->moving_joints, (std::vector<std::string>{"left_wheel_joint", "right_wheel_joint"}));
}

TEST(ReadDriveTrain, TheHashSaysWhatTheWheelsTake) {
  DriveTrainParameters velocity;
  velocity.wheel_command = WheelCommand::kVelocity;
  const std::uint64_t hash = read_drive_train(diffbot_urdf(), velocity).hash;
  EXPECT_NE(read_drive_train(diffbot_urdf(), {}).hash, hash);
  velocity.wheel_response_time *= 2;
  EXPECT_NE(read_drive_train(diffbot_urdf(), velocity).hash, hash);
}

TEST(DriveTrain, EqualHashMeansEqualRobot) {
  const std::uint64_t hash = read_drive_train(diffbot_urdf(), {}).hash;
  EXPECT_EQ(read_drive_train(diffbot_urdf(), {}).hash, hash);
  EXPECT_NE(read_drive_train(diffbot_with("<robot", "6.0", "6.1"), {}).hash, hash);
  DriveTrainParameters wider;
  wider.wheel_base = 0.5;
  EXPECT_NE(read_drive_train(diffbot_urdf(), wider).hash, hash);
  DriveTrainParameters larger;
  larger.wheel_radius = 0.5;
  EXPECT_NE(read_drive_train(diffbot_urdf(), larger).hash, read_drive_train(diffbot_urdf(), wider).hash);
  const auto changed = [&](auto change) {
    DriveTrainParameters parameters;
    change(parameters);
    return read_drive_train(diffbot_urdf(), parameters).hash != hash;
  };
  EXPECT_TRUE(changed([](DriveTrainParameters& p) { p.wheel_base_multiplier = 1.1; }));
  EXPECT_TRUE(changed([](DriveTrainParameters& p) { p.wheel_effort_limit = 1; }));
  EXPECT_TRUE(changed([](DriveTrainParameters& p) { p.wheel_velocity_limit = 1; }));
  EXPECT_TRUE(changed([](DriveTrainParameters& p) { p.wheel_effort_rate = 1; }));
  EXPECT_TRUE(changed([](DriveTrainParameters& p) { p.mass = 13; }));
  EXPECT_TRUE(changed([](DriveTrainParameters& p) { p.centre_of_gravity = Vector3{}; }));
  EXPECT_TRUE(changed([](DriveTrainParameters& p) { p.imu_link = "base_link"; }));
  EXPECT_TRUE(changed([](DriveTrainParameters& p) { p.imu_position = Vector3{}; }));
  EXPECT_TRUE(changed([](DriveTrainParameters& p) { p.imu_orientation = Vector3{}; }));
  EXPECT_TRUE(changed([](DriveTrainParameters& p) {
    p.left_wheel_joints = {"left_wheel_joint"};
    p.right_wheel_joints = {"right_wheel_joint"};
  }));
}

TEST(DriveTrain, ImuSitsAtItsLink) {
  const DriveTrain robot = read_drive_train(diffbot_with("<joint name=\"imu_joint\"", "xyz=\"0.05 0.02 0.06\"",
                                                         "xyz=\"0.05 0.02 0.06\" rpy=\"0 0 1.5707963267948966\""),
                                            {});
  EXPECT_EQ(robot.imu_link, "imu_link");
  EXPECT_NEAR(robot.imu_in_base.position[0], 0.05, kRounding);
  EXPECT_NEAR(robot.imu_in_base.position[1], 0.02, kRounding);
  EXPECT_NEAR(robot.imu_in_base.position[2], 0.06, kRounding);
  EXPECT_NEAR(robot.imu_in_base.orientation[2], std::sqrt(0.5), kRounding);
  EXPECT_NEAR(robot.imu_in_base.orientation[3], std::sqrt(0.5), kRounding);
}

// Roll, pitch and yaw turn about fixed axes in this order. After roll and yaw by a right angle each, x of an IMU points
// to the left, and its y up.
TEST(DriveTrain, AnotherPlaceOfTheImuReplacesTheUrdfs) {
  DriveTrainParameters parameters;
  parameters.imu_position = Vector3{-0.1, 0.03, 0.2};
  parameters.imu_orientation = Vector3{std::acos(0.0), 0, std::acos(0.0)};
  const DriveTrain robot = read_drive_train(diffbot_urdf(), parameters);
  EXPECT_EQ(robot.imu_link, "imu_link");
  EXPECT_EQ(robot.imu_in_base.position, (Vector3{-0.1, 0.03, 0.2}));
  for (const double component : robot.imu_in_base.orientation) EXPECT_NEAR(component, 0.5, kRounding);
  std::vector<std::string> noted;
  for (const RobotNote& note : robot.notes) {
    if (note.kind == RobotNote::Kind::kOverridden) noted.push_back(note.element + ": " + note.text);
  }
  EXPECT_EQ(noted, (std::vector<std::string>{
                       "robot.imu_position: -0.1, 0.03, 0.2 m is used, the URDF has 0.05, 0.02, 0.06 m",
                       "robot.imu_orientation: 1.5708, 0, 1.5708 rad is used, the URDF has 0, 0, 0 rad"}));
}

// The differences are 4 mm of a wheel base of 0.5 m, and 0.005 rad: the accuracy of a ruler and of a screw.
TEST(DriveTrain, AnImuAlmostWhereTheUrdfSaysIsNotNoted) {
  DriveTrainParameters parameters;
  parameters.imu_position = Vector3{0.054, 0.02, 0.06};
  parameters.imu_orientation = Vector3{0, 0, 0.005};
  const DriveTrain robot = read_drive_train(diffbot_urdf(), parameters);
  EXPECT_EQ(robot.imu_in_base.position[0], 0.054);
  EXPECT_EQ(robot.notes.size(), read_drive_train(diffbot_urdf(), {}).notes.size());
}

TEST(DriveTrain, TheImuIsInTheBaseWithoutAnImuLink) {
  RobotDescription description = diffbot_with("<robot", "<link name=\"imu_link\">", "<link name=\"box_link\">");
  description.text = replaced(description.text, "<robot", "<child link=\"imu_link\"/>", "<child link=\"box_link\"/>");
  const DriveTrain robot = read_drive_train(description, {});
  EXPECT_EQ(robot.imu_link, "");
  EXPECT_EQ(robot.imu_in_base.position, (Vector3{0, 0, 0}));
  EXPECT_EQ(robot.imu_in_base.orientation, (Quaternion{0, 0, 0, 1}));
}

// Steiner: two point-like masses m at ±d on x have m·d² each about y and z, wherever they are.
TEST(RigidBodies, FixedLinksAreLumpedByTheParallelAxisTheorem) {
  const std::string mass = inertial("2", "ixx=\"0.1\" iyy=\"0.1\" izz=\"0.1\" ixy=\"0\" ixz=\"0\" iyz=\"0\"");
  const std::string fixed =
      joint({.name = "j", .child = "b", .xyz = "1 0 0", .type = "fixed", .parent = "a", .rpy = "0 0 1"});
  const RigidBodies robot = read_rigid_bodies(robot_of(link("a", mass) + link("b", mass) + fixed));
  ASSERT_EQ(robot.bodies.size(), 1u);
  const RigidBody& body = robot.bodies[0];
  EXPECT_NEAR(body.mass, 4, kRounding);
  EXPECT_NEAR((body.centre_of_gravity - Eigen::Vector3d(0.5, 0, 0)).norm(), 0, kRounding);
  const Eigen::Matrix3d expected = Eigen::Vector3d(0.2, 0.2 + 2 * 2 * 0.25, 0.2 + 2 * 2 * 0.25).asDiagonal();
  EXPECT_NEAR((body.inertia - expected).norm(), 0, kRounding);
}

}  // namespace robot_control::tests
