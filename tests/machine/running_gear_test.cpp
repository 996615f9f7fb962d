/// The parts that carry a robot besides its drive wheels: casters with and without a swivel, rockers, many axles,
/// tracks.

#include <cmath>

#include "machine/bodies/rigid_bodies.h"
#include "machine/urdf_text.h"
#include "support/matchers.h"

namespace robot_control::tests {

/// A wheel of 0.1 m below an upright swivel, which it follows by `trail`.
std::string swivel(const std::string& trail) {
  return link("fork", inertial("0.2")) +
         joint({.name = "swivel", .child = "fork", .xyz = "-0.3 0 0", .axis = "<axis xyz=\"0 0 1\"/>"}) +
         link("roller", inertial("0.2") + tyre("0.1")) +
         joint({.name = "caster", .child = "roller", .xyz = trail, .parent = "fork"});
}

TEST(Caster, RollsWhereItIsTurnedIfItFollowsItsSwivel) {
  const DriveTrain robot = read_drive_train(robot_of(two_wheels() + swivel("-0.03 0 0")), {});
  ASSERT_EQ(robot.casters.size(), 1u);
  EXPECT_FALSE(robot.casters[0].omni);
}

// An offset along the axle is no trail.
TEST(Caster, BelowItsSwivelSlides) {
  for (const char* trail : {"0 0 0", "0 0.03 0"}) {
    const DriveTrain robot = read_drive_train(robot_of(two_wheels() + swivel(trail)), {});
    EXPECT_TRUE(robot.casters.empty()) << trail;
    EXPECT_THAT(notes_of(robot, RobotNote::Kind::kAssumed), HasSubstr("below its swivel, which cannot turn it"));
  }
}

TEST(Caster, IsAnOmniWheelWithoutASwivel) {
  const DriveTrain robot = read_drive_train(robot_of(two_wheels() + wheel("rear", "-0.3 0 0")), {});
  ASSERT_EQ(robot.casters.size(), 1u);
  EXPECT_TRUE(robot.casters[0].omni);
  EXPECT_THAT(notes_of(robot, RobotNote::Kind::kAssumed), HasSubstr("it has no swivel"));
}

/// Two wheels on an arm on the side of `y`, which pitches about the body's middle.
std::string rocker(const std::string& name, const std::string& y, const std::string& axis = "0 1 0",
                   const std::string& rest = "") {
  const std::string arm = name + "_arm";
  const std::string limits = "<limit lower=\"-0.2\" upper=\"0.2\" effort=\"0\" velocity=\"0\"/>";
  std::string text = link(arm, inertial("2")) + joint({.name = name,
                                                       .child = arm,
                                                       .xyz = "0 " + y + " 0",
                                                       .type = "revolute",
                                                       .axis = "<axis xyz=\"" + axis + "\"/>",
                                                       .rest = limits + rest});
  for (const std::string end : {"front", "rear"}) {
    const std::string each = name + "_" + end;
    text +=
        link(each + "_link", inertial("1") + tyre("0.1")) +
        joint({.name = each, .child = each + "_link", .xyz = end == "front" ? "0.2 0 0" : "-0.2 0 0", .parent = arm});
  }
  return text;
}

const BodyJoint& right_rocker(const DriveTrain& robot) {
  return robot.bodies->moved_by("right")->joint;
}

TEST(Rockers, AreJoinedByADifferential) {
  const DriveTrain robot = read_drive_train(robot_of(base() + rocker("left", "0.25") + rocker("right", "-0.25")), {});
  EXPECT_EQ(right_rocker(robot).mimicked, "left");
  EXPECT_EQ(right_rocker(robot).mimic_multiplier, -1);
  EXPECT_THAT(notes_of(robot, RobotNote::Kind::kAssumed), HasSubstr("a differential"));
}

TEST(Rockers, TurnTheSameWayWithOppositeAxes) {
  const DriveTrain robot =
      read_drive_train(robot_of(base() + rocker("left", "0.25", "0 -1 0") + rocker("right", "-0.25")), {});
  EXPECT_EQ(right_rocker(robot).mimic_multiplier, 1);
}

TEST(Rockers, AreLeftAloneIfTheUrdfTiesThem) {
  const std::string mimic = "<mimic joint=\"left\" multiplier=\"-0.5\"/>";
  const DriveTrain robot =
      read_drive_train(robot_of(base() + rocker("left", "0.25") + rocker("right", "-0.25", "0 1 0", mimic)), {});
  EXPECT_EQ(right_rocker(robot).mimic_multiplier, -0.5);
  EXPECT_THAT(notes_of(robot, RobotNote::Kind::kAssumed), Not(HasSubstr("differential")));
}

// 10 g with 1 kg·m² give 10 m. The robot is the box about body and wheels.
TEST(Inertia, IsScaledDownToTheRobotsSize) {
  const std::string tensor = "ixx=\"1\" iyy=\"0.01\" izz=\"1\" ixy=\"0\" ixz=\"0\" iyz=\"0\"";
  const std::string sensor = link("sensor", inertial("0.01", tensor)) +
                             joint({.name = "mount", .child = "sensor", .type = "fixed", .axis = ""});
  const double without = read_drive_train(robot_of(two_wheels()), {}).yaw_inertia;
  const DriveTrain robot = read_drive_train(robot_of(two_wheels() + sensor), {});
  EXPECT_THAT(notes_of(robot, RobotNote::Kind::kRepaired),
              HasSubstr("<link name=\"sensor\">: a radius of gyration of 10 m"));
  EXPECT_GT(robot.yaw_inertia, without);
  EXPECT_LT(robot.yaw_inertia, without + 0.01 * 1.5 * 1.5);
}

std::string axles(const std::vector<std::string>& positions) {
  std::string text = base();
  for (const std::string& x : positions) text += wheel("left" + x, x + " 0.25 0") + wheel("right" + x, x + " -0.25 0");
  return text;
}

// b = 0.5, x = 0.3, 0, −0.3: with s the slip, b/2 (1 + 2 s/√(s² + x²)) = 2 x²/√(s² + x²).
TEST(ScrubMultiplier, BalancesTheMomentsOfThreeAxles) {
  const DriveTrain robot = read_drive_train(robot_of(axles({"0.3", "0", "-0.3"})), {});
  const double slip = (robot.wheel_base_multiplier - 1) * 0.5 / 2;
  const double speed = std::hypot(slip, 0.3);
  EXPECT_NEAR(0.25 * (1 + 2 * slip / speed), 2 * 0.09 / speed, 1e-9);
  EXPECT_GT(slip, 0);
}

// The middle axle alone outweighs the outer two, 1 cm away: b/2 > 2 · 0.01.
TEST(ScrubMultiplier, IsOneForAxlesThatStandClose) {
  EXPECT_NEAR(read_drive_train(robot_of(axles({"0.01", "0", "-0.01"})), {}).wheel_base_multiplier, 1, kRounding);
}

TEST(ScrubMultiplier, IsDoubtfulForUnequalLoads) {
  const std::string load =
      "<inertial><origin xyz=\"0 -0.1 0\"/><mass value=\"10\"/><inertia " + kBall + "/></inertial>";
  const std::string text = axles({"0.2", "-0.2"}) + link("cargo", load) +
                           joint({.name = "bed", .child = "cargo", .type = "fixed", .axis = ""});
  // 10 of 24 kg
  EXPECT_THAT(notes_of(read_drive_train(robot_of(text), {}), RobotNote::Kind::kSuspicious),
              HasSubstr("-0.041667 m left"));
  EXPECT_THAT(notes_of(read_drive_train(robot_of(axles({"0.2", "-0.2"})), {}), RobotNote::Kind::kSuspicious),
              Not(HasSubstr("equal loads")));
}

TEST(Tracks, AreRefusedForTheirManyRollers) {
  EXPECT_THAT(refusal_of(robot_of(axles({"0.4", "0.2", "0", "-0.2", "-0.4"}))),
              HasSubstr("it is not clear which of 10 wheels drive, and tracks are not supported"));
}

TEST(Tracks, DriveOnTheWheelsThatAreGiven) {
  EXPECT_EQ(
      refusal_of(robot_of(axles({"0.4", "0.2", "0", "-0.2", "-0.4"}) + transmission("left0") + transmission("right0"))),
      "accepted");
}

}  // namespace robot_control::tests
