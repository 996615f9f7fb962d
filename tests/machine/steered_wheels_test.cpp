/// Machines without differential drive: omni wheels, rollers, steered wheels, a drive that the file names.

#include <array>
#include <cmath>

#include "machine/bodies/rigid_bodies.h"
#include "machine/random_text.h"
#include "machine/urdf_text.h"
#include "support/matchers.h"

namespace robot_control::tests {

std::string four_wheels() {
  return two_wheels() + wheel("rear_left", "-0.3 0.25 0") + wheel("rear_right", "-0.3 -0.25 0");
}

std::string plugin(const std::string& file) {
  return "<gazebo><plugin name=\"p\" filename=\"" + file + "\"><commandTopic>cmd_vel</commandTopic></plugin></gazebo>";
}

TEST(HolonomicDrive, PluginsThatMoveARobotSidewaysAreNoted) {
  for (const std::string file : {"libgazebo_ros_planar_move.so", "libgazebo_ros_mecanum_drive.so", "libomni_drive.so",
                                 "libgazebo_ros_force_based_move.so", "libholonomic_move.so", "libswerve_drive.so"}) {
    for (const std::string& wheels : {two_wheels(), four_wheels()}) {
      const DriveTrain robot = read_drive_train(robot_of(wheels + plugin(file)), {});
      EXPECT_THAT(notes_of(robot, RobotNote::Kind::kSuspicious), AllOf(HasSubstr(file), HasSubstr("sideways"))) << file;
    }
  }
  const DriveTrain plain = read_drive_train(robot_of(two_wheels() + plugin("libgazebo_ros_diff_drive.so")), {});
  EXPECT_THAT(notes_of(plain, RobotNote::Kind::kSuspicious), Not(HasSubstr("sideways")));
}

/// A wheel with n rollers about a hub of 0.08 m, each turned by `slant` from the rolling direction, as joints or as
/// shapes.
std::string roller_wheel(const std::string& name, const std::string& place, int n, double slant, bool joints) {
  std::string shapes = tyre("0.08"), more;
  for (int i = 0; i < n; ++i) {
    const double phi = 2 * M_PI * i / n;
    // Tangent of the rim at φ, then turned by the slant about the radius.
    const std::string at = xyz(0.09 * std::sin(phi), 0, 0.09 * std::cos(phi));
    const std::string rpy = xyz(0, phi + M_PI / 2, 0);
    const std::string each = "<cylinder radius=\"0.01\" length=\"0.03\"/>";
    const std::string roller = name + "_roller_" + std::to_string(i);
    if (joints) {
      const std::string axis = "<axis xyz=\"" + xyz(0, std::sin(slant), std::cos(slant)) + "\"/>";
      more += link(roller, inertial("0.01") + collision(each)) + joint({.name = roller + "_joint",
                                                                        .child = roller,
                                                                        .xyz = at,
                                                                        .axis = axis,
                                                                        .parent = name + "_link",
                                                                        .rpy = rpy});
    } else {
      shapes += collision(each, "xyz=\"" + at + "\" rpy=\"" + xyz(slant, phi + M_PI / 2, 0) + "\"");
    }
  }
  return link(name + "_link", inertial("1") + shapes) + joint({.name = name, .child = name + "_link", .xyz = place}) +
         more;
}

TEST(HolonomicDrive, RollersOnTheWheelsAreRefusedWithTheReason) {
  for (unsigned seed = 0; seed < 30; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const int n = 5 + static_cast<int>(below(random, 3));
    const double slant = toss(random) ? 0 : (toss(random) ? 1 : -1) * M_PI / 4;
    const bool joints = toss(random);
    std::string text = base() + roller_wheel("fl", "0.2 0.25 0", n, slant, joints) +
                       roller_wheel("fr", "0.2 -0.25 0", n, -slant, joints);
    if (!joints && toss(random)) {
      text +=
          roller_wheel("rl", "-0.2 0.25 0", n, -slant, joints) + roller_wheel("rr", "-0.2 -0.25 0", n, slant, joints);
    }
    EXPECT_THAT(refusal_of(robot_of(text)),
                AllOf(HasSubstr("rollers"), AnyOf(HasSubstr("omni"), HasSubstr("mecanum"))));
  }
}

TEST(DriveWheel, IsRefusedIfItHangsOnAnotherOne) {
  const std::string text = base() + wheel("left", "0 0.25 0") + link("right_link", inertial("1") + tyre("0.1")) +
                           joint({.name = "right", .child = "right_link", .xyz = "0 -0.5 0", .parent = "left_link"});
  DriveTrainParameters named;
  named.left_wheel_joints = {"left"};
  named.right_wheel_joints = {"right"};
  for (const DriveTrainParameters& parameters : {DriveTrainParameters(), named}) {
    EXPECT_THAT(refusal_of(robot_of(text), parameters),
                AllOf(HasSubstr("<joint name=\"right\">"), HasSubstr("moves with another drive wheel, left")));
  }
}

constexpr std::array<const char*, 4> kPlaces{"0.2 0.25 0", "0.2 -0.25 0", "-0.2 0.25 0", "-0.2 -0.25 0"};

TEST(HolonomicDrive, OneWheelWithRollersAmongPlainOnesIsNamedFirst) {
  for (const bool joints : {true, false}) {
    for (std::size_t odd = 0; odd < kPlaces.size(); ++odd) {
      std::string text = base();
      for (std::size_t i = 0; i < kPlaces.size(); ++i) {
        const std::string name = "w" + std::to_string(i);
        text += i == odd ? roller_wheel(name, kPlaces[i], 8, M_PI / 4, joints) : wheel(name, kPlaces[i]);
      }
      EXPECT_THAT(refusal_of(robot_of(text)),
                  AllOf(HasSubstr("<joint name=\"w" + std::to_string(odd) + "\">: its rim is 8 rollers"),
                        HasSubstr("Remove the rollers"), Not(HasSubstr("robot.left_wheel_joints"))))
          << odd;
    }
  }
}

/// Plain wheels in front and, `drop` m deeper, wheels with rollers behind; wheels that are not named as driven are
/// casters.
std::string with_roller_wheels_behind(double drop, bool joints) {
  const auto behind = [&](double y) { return xyz(-0.2, y, -drop); };
  return base() + wheel("fl", kPlaces[0]) + wheel("fr", kPlaces[1]) + roller_wheel("rl", behind(0.25), 8, 0, joints) +
         roller_wheel("rr", behind(-0.25), 8, 0, joints);
}

TEST(HolonomicDrive, RollersBesideADriveAreRefusedWhereTheyMayDriveAndCastersWhereTheyDoNot) {
  for (const bool joints : {true, false}) {
    const std::string alike = with_roller_wheels_behind(0, joints);
    EXPECT_THAT(refusal_of(robot_of(alike)), AllOf(HasSubstr("rl"), HasSubstr("rollers"), HasSubstr("as high as")));
    EXPECT_NO_THROW(read_drive_train(robot_of(alike + transmission("fl") + transmission("fr")), {}));
    EXPECT_NO_THROW(read_drive_train(robot_of(with_roller_wheels_behind(0.02, joints)), {}));
    const std::string all = alike + transmission("fl") + transmission("fr") + transmission("rl") + transmission("rr");
    EXPECT_THAT(refusal_of(robot_of(all)), HasSubstr("rollers"));
    DriveTrainParameters named;
    named.left_wheel_joints = {"fl"};
    named.right_wheel_joints = {"fr"};
    EXPECT_THAT(notes_of(read_drive_train(robot_of(alike), named), RobotNote::Kind::kSuspicious), HasSubstr("rollers"));
  }
}

TEST(HolonomicDrive, ADriveWheelThatIsCalledMecanumOrOmniIsRefusedEvenIfItIsTheOnlyOne) {
  for (const std::string word : {"mecanum", "Omni"}) {
    for (const std::string& others : {std::string(), wheel("rl", kPlaces[2]) + wheel("rr", kPlaces[3])}) {
      const std::string text = base() + wheel(word + "_left", kPlaces[0]) + wheel("fr", kPlaces[1]) + others;
      EXPECT_THAT(refusal_of(robot_of(text)), AllOf(HasSubstr(word + "_left"), HasSubstr("its name contains"),
                                                    HasSubstr("Set robot.left_wheel_joints")));
    }
  }
  DriveTrainParameters named;
  named.left_wheel_joints = {"omni_left"};
  named.right_wheel_joints = {"fr"};
  const DriveTrain robot =
      read_drive_train(robot_of(base() + wheel("omni_left", kPlaces[0]) + wheel("fr", kPlaces[1])), named);
  EXPECT_THAT(notes_of(robot, RobotNote::Kind::kSuspicious), HasSubstr("its name contains omni"));
}

/// A robot of four wheels. `name`, `base` and `wheel` appear in the names of robot, root link and the front left
/// wheel's link, `mesh` in a mesh of the body.
std::string base_with_names(const std::string& robot, const std::string& root, const std::string& mesh,
                            const std::string& behind = "") {
  std::string text =
      four_wheels() +
      link("cover", "<visual><geometry><mesh filename=\"package://a/" + mesh + "\"/></geometry></visual>") +
      joint({.name = "cover_joint", .child = "cover", .type = "fixed", .axis = ""});
  for (std::size_t at = 0; (at = text.find("base_link", at)) != std::string::npos; at += root.size()) {
    text.replace(at, 9, root);
  }
  return "<robot name=\"" + robot + "\">" + text + "</robot>" + behind;
}

std::string suspicions(const std::string& text) {
  return notes_of(read_drive_train({text, "r.urdf"}, {}), RobotNote::Kind::kSuspicious);
}

TEST(HolonomicDrive, NamesOfABaseThatSayItAreNotedOnceInPlainWords) {
  const auto plainly = [](const std::string& element) {
    return AllOf(HasSubstr(element), HasSubstr("does not move sideways, and its turns differ"));
  };
  EXPECT_THAT(suspicions(base_with_names("nexus_MECANUM_4wd", "base_link", "a.stl")), plainly("nexus_MECANUM_4wd"));
  EXPECT_THAT(suspicions(base_with_names("OmniBot", "base_link", "a.stl")), plainly("OmniBot"));
  EXPECT_THAT(suspicions(base_with_names("a_holonomic_base", "base_link", "a.stl")), plainly("a_holonomic_base"));
  EXPECT_THAT(suspicions(base_with_names("r", "omni_base", "a.stl")), plainly("omni_base"));
  EXPECT_THAT(suspicions(base_with_names("r", "base_link", "mecanum_wheel.dae")), plainly("mecanum_wheel.dae"));
  const std::string macros = "<!-- xacro macros: imu mecanum_wheel -->";
  EXPECT_THAT(suspicions(base_with_names("r", "base_link", "a.stl", macros)), plainly("<xacro:mecanum_wheel>"));
  const std::string banner = "<!-- |  This document was autogenerated by xacro from /w/omni3.urdf.xacro  | -->";
  EXPECT_THAT(suspicions(banner + base_with_names("r", "base_link", "a.stl")), plainly("omni3.urdf.xacro"));
  const std::string several = suspicions(base_with_names("mecanum", "omni_base", "mecanum.stl"));
  EXPECT_THAT(several, plainly("<robot name=\"mecanum\">"));
  EXPECT_EQ(several.find("sideways"), several.rfind("sideways"));
}

TEST(HolonomicDrive, NamesThatSayNothingOfTheDriveAreNotNoted) {
  for (const std::string name : {"r", "nonholonomic_base", "non-holonomic", "omniverse_robot", "omni_camera"}) {
    EXPECT_THAT(suspicions(base_with_names(name, "base_link", "a.stl")), Not(HasSubstr("sideways"))) << name;
  }
  EXPECT_THAT(suspicions(base_with_names("r", "base_link", "omni_lidar.stl")), Not(HasSubstr("sideways")));
  const std::string caster = two_wheels() + wheel("omni_caster", "-0.3 0 0", "0.1");
  EXPECT_THAT(suspicions("<robot name=\"mecanum_lab\">" + caster + "</robot>"), Not(HasSubstr("sideways")));
}

TEST(HolonomicDrive, AJointWhoseNameSaysItOnARobotThatSaysItIsNoted) {
  std::string text = base();
  for (const char* place : kPlaces) text += wheel("mecanum_" + std::to_string(text.size()), place);
  EXPECT_THAT(suspicions("<robot name=\"mecanum_bot\">" + text + "</robot>"),
              AllOf(HasSubstr("its name contains mecanum, as 8 other names do"), HasSubstr("does not move sideways")));
}

TEST(HolonomicDrive, WheelsThatRollAcrossAreRefusedWithTheReason) {
  const auto across = [](const std::string& name, double x, double y, double yaw) {
    return link(name + "_link", inertial("1") + tyre("0.1")) +
           joint({.name = name, .child = name + "_link", .xyz = xyz(x, y, 0), .rpy = xyz(0, 0, yaw)});
  };
  for (unsigned seed = 0; seed < 20; ++seed) {
    Random random(seed);
    const double yaw = M_PI / 2 + between(random, -0.6, 0.6);
    const std::string plus =
        two_wheels() + across("front", 0.3, 0, yaw) + (toss(random) ? across("back", -0.3, 0, -yaw) : "");
    EXPECT_THAT(refusal_of(robot_of(plus)), AllOf(HasSubstr("front"), HasSubstr("° off"), HasSubstr("floor"))) << seed;
  }
}

/// A wheel below a steering joint, `offset` m outwards from it.
std::string steered(const std::string& name, double x, double y, double offset, const std::string& type,
                    const std::string& limit) {
  return link(name + "_knuckle", inertial("0.3")) +
         joint({.name = name + "_steer",
                .child = name + "_knuckle",
                .xyz = xyz(x, y, 0),
                .type = type,
                .axis = "<axis xyz=\"0 0 1\"/>",
                .rest = limit}) +
         link(name + "_link", inertial("1") + tyre("0.1")) +
         joint({.name = name, .child = name + "_link", .xyz = xyz(0, offset, 0), .parent = name + "_knuckle"});
}

const std::string kSteering = "<limit lower=\"-0.6\" upper=\"0.6\" effort=\"5\" velocity=\"2\"/>";

TEST(SteeredWheels, AreRefusedWithTheReason) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const double x = between(random, 0.2, 0.6) * (toss(random) ? 1 : -1);
    const double offset = toss(random) ? 0 : between(random, 0, 0.05);
    const bool limited = toss(random);
    const std::string type = limited ? "revolute" : "continuous";
    std::string text = two_wheels() + steered("sl", x, 0.25, offset, type, limited ? kSteering : "") +
                       steered("sr", x, -0.25, -offset, type, limited ? kSteering : "");
    const std::size_t named = limited ? below(random, 4) : 1 + below(random, 3);
    if (named == 1) text += transmission("sl") + transmission("sr");              // only those that are steered drive
    if (named == 2) text += transmission("sl_steer") + transmission("sr_steer");  // only the steering
    if (named == 3)
      text += transmission("left") + transmission("right") + transmission("sl_steer") + transmission("sr_steer");
    EXPECT_THAT(refusal_of(robot_of(text)),
                AllOf(HasSubstr("sl"), HasSubstr("steer"), HasSubstr("robot.left_wheel_joints")));
  }
}

TEST(SteeredWheels, AreNotedBesideWheelsThatAreNamed) {
  DriveTrainParameters named;
  named.left_wheel_joints = {"left"};
  named.right_wheel_joints = {"right"};
  const std::string text = two_wheels() + steered("sl", 0.4, 0.25, 0, "revolute", kSteering) +
                           steered("sr", 0.4, -0.25, 0, "revolute", kSteering);
  EXPECT_THAT(notes_of(read_drive_train(robot_of(text), named), RobotNote::Kind::kSuspicious),
              AllOf(HasSubstr("sl"), HasSubstr("steered")));
}

TEST(SteeredWheels, AllOfThemAreRefusedWithTheReason) {
  const std::string text =
      base() + steered("fl", 0.3, 0.25, 0, "continuous", "") + steered("fr", 0.3, -0.25, 0, "continuous", "") +
      steered("rl", -0.3, 0.25, 0, "continuous", "") + steered("rr", -0.3, -0.25, 0, "continuous", "");
  EXPECT_THAT(refusal_of(robot_of(text)), AllOf(HasSubstr("fl"), HasSubstr("swivel")));
}

TEST(SteeredWheels, ADrivenCasterIsNoted) {
  const std::string caster =
      link("fork", inertial("0.2")) +
      joint({.name = "swivel", .child = "fork", .xyz = "-0.3 0.1 0", .axis = "<axis xyz=\"0 0 1\"/>"}) +
      link("roller", inertial("0.2") + tyre("0.1")) +
      joint({.name = "caster", .child = "roller", .xyz = "-0.03 0 0", .parent = "fork"});
  EXPECT_THAT(notes_of(read_drive_train(robot_of(two_wheels() + caster + transmission("caster")), {}),
                       RobotNote::Kind::kSuspicious),
              AllOf(HasSubstr("caster"), HasSubstr("driven")));
}

// The front wheel of a tricycle is driven.
TEST(NamedDrive, AWheelOnTheMiddleLineThatTheFileDrivesIsRefused) {
  EXPECT_THAT(refusal_of(robot_of(two_wheels() + wheel("front", "0.4 0 0") + transmission("front"))),
              AllOf(HasSubstr("front"), HasSubstr("middle line"), HasSubstr("driven")));
}

TEST(NamedDrive, TransmissionsBind) {
  for (unsigned seed = 0; seed < 16; ++seed) {
    const std::vector<std::string> names{"left", "right", "rear_left", "rear_right"};
    std::string text = four_wheels();
    std::size_t count = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      if ((seed >> i & 1U) == 0) continue;
      text += transmission(names[i]);
      ++count;
    }
    const std::string refusal = refusal_of(robot_of(text));
    const bool pairs = count == 0 || count == 4 || seed == 3 || seed == 12;
    if (pairs) {
      EXPECT_EQ(refusal, "accepted") << seed;
      EXPECT_EQ(read_drive_train(robot_of(text), {}).wheels.size(), count == 0 ? 4 : count) << seed;
    } else {
      EXPECT_THAT(refusal, AllOf(HasSubstr("the file names"), HasSubstr("driven"))) << seed;
    }
  }
}

TEST(NamedDrive, WheelsThatFollowOthersByMimicAreDrivenWithANote) {
  for (const std::string leader : {"left", "right"}) {
    for (const bool said : {false, true}) {
      std::string text = two_wheels() + wheel("rear_left", "-0.3 0.25 0", "0.1", "<mimic joint=\"left\"/>") +
                         wheel("rear_right", "-0.3 -0.25 0", "0.1", "<mimic joint=\"" + leader + "\"/>");
      if (said) text += transmission("left") + transmission("right");
      const DriveTrain robot = read_drive_train(robot_of(text), {});
      EXPECT_EQ(robot.wheels.size(), 4u);
      EXPECT_THAT(notes_of(robot, RobotNote::Kind::kSuspicious),
                  AllOf(HasSubstr("rear_left"), HasSubstr("<mimic joint")));
      EXPECT_EQ(robot.bodies->moved_by("rear_right")->joint.mimicked, "");
    }
  }
  const std::string pair =
      base() + wheel("left", "0 0.25 0") + wheel("right", "0 -0.25 0", "0.1", "<mimic joint=\"left\"/>");
  EXPECT_THAT(notes_of(read_drive_train(robot_of(pair), {}), RobotNote::Kind::kSuspicious), HasSubstr("<mimic joint"));
}

}  // namespace robot_control::tests
