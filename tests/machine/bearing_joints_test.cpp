/// Joints between the body and the floor: legs that fold are refused, robots that only look like them stand.

#include "machine/random_text.h"
#include "machine/urdf_text.h"
#include "support/matchers.h"

namespace robot_control::tests {

struct Leg {
  std::string name = "";
  double x = 0, y = 0;
  bool abduction = true;  ///< a joint about x above hip and knee
  double bent = 0;        ///< rad, of hip and knee, one against the other
  std::string limits = "<limit lower=\"-1\" upper=\"1\" effort=\"24\" velocity=\"20\"/>";
  std::string type = "revolute";
  std::string wheel = tyre("0.08");
};

/// Thigh and calf of 0.2 m, at whose end a wheel of 0.08 m turns.
std::string leg(const Leg& leg) {
  const auto part = [&](const std::string& name, const std::string& parent, const std::string& place, double pitch,
                        const std::string& axis) {
    return link(name, inertial("0.5")) + joint({.name = name + "_joint",
                                                .child = name,
                                                .xyz = place,
                                                .type = leg.type,
                                                .axis = "<axis xyz=\"" + axis + "\"/>",
                                                .rest = leg.limits,
                                                .parent = parent,
                                                .rpy = xyz(0, pitch, 0)});
  };
  const std::string hip = leg.name + "_hip", thigh = leg.name + "_thigh", calf = leg.name + "_calf";
  std::string text;
  if (leg.abduction) text += part(hip, "base_link", xyz(leg.x, leg.y / 2, 0), 0, "1 0 0");
  text += part(thigh, leg.abduction ? hip : "base_link",
               xyz(leg.abduction ? 0 : leg.x, leg.abduction ? leg.y / 2 : leg.y, 0), leg.bent, "0 1 0");
  text += part(calf, thigh, "0 0 -0.2", -2 * leg.bent, "0 1 0");
  return text + link(leg.name + "_wheel", inertial("0.5") + leg.wheel) +
         joint({.name = leg.name + "_foot_joint",
                .child = leg.name + "_wheel",
                .xyz = "0 0 -0.2",
                .parent = calf,
                .rpy = xyz(0, leg.bent, 0)});
}

std::string quadruped(Leg each) {
  std::string text = base();
  for (const double x : {0.25, -0.25}) {
    for (const double y : {0.2, -0.2}) {
      each.name = std::string(x > 0 ? "F" : "R") + (y > 0 ? "L" : "R");
      each.x = x;
      each.y = y;
      text += leg(each);
    }
  }
  return text;
}

TEST(BearingJoints, AreNamedAndRefusedInALegThatNothingHolds) {
  const std::string endless = "<limit effort=\"24\" velocity=\"20\"/>";
  for (const bool abduction : {true, false}) {
    for (const double bent : {0.0, 0.3, -0.7}) {
      for (const bool turns_on : {true, false}) {
        Leg each{.abduction = abduction, .bent = bent};
        if (turns_on) each.limits = endless, each.type = "continuous";
        const std::string said = refusal_of(robot_of(quadruped(each)));
        EXPECT_THAT(said,
                    AllOf(HasSubstr("FL_thigh_joint"), HasSubstr("RR_calf_joint"), HasSubstr("without effort limit"),
                          HasSubstr("the robot would sink"), HasSubstr("type=\"fixed\"")))
            << abduction << bent << turns_on;
        EXPECT_EQ(said.find("RL_hip_joint") != std::string::npos, abduction) << said;
        EXPECT_THAT(said, Not(HasSubstr("foot_joint,")));
      }
    }
  }
}

TEST(BearingJoints, AreAcceptedIfTheyAreFixedOrMoveLittleOrRubHard) {
  Leg fixed{.limits = "", .type = "fixed"};
  EXPECT_EQ(refusal_of(robot_of(quadruped(fixed))), "accepted");
  Leg little{.limits = "<limit lower=\"-0.02\" upper=\"0.02\" effort=\"24\" velocity=\"20\"/>"};
  EXPECT_EQ(refusal_of(robot_of(quadruped(little))), "accepted");
  Leg rubbing;
  rubbing.limits += "<dynamics friction=\"200\"/>";
  EXPECT_EQ(refusal_of(robot_of(quadruped(rubbing))), "accepted");
}

/// The user's own names of the wheels do not change the physics.
TEST(BearingJoints, AreRefusedForNamedWheels) {
  DriveTrainParameters named;
  named.left_wheel_joints = {"FL_foot_joint", "RL_foot_joint"};
  named.right_wheel_joints = {"FR_foot_joint", "RR_foot_joint"};
  EXPECT_THAT(refusal_of(robot_of(quadruped({})), named), HasSubstr("without effort limit"));
}

/// Swing arms on which half of the robot's wheels hang; `more` is added beside them.
std::string swing_arms(const std::string& more) {
  std::string text = base();
  for (const std::string side : {"left", "right"}) {
    const std::string arm = side + "_arm";
    text += link(arm, inertial("0.5")) +
            joint({.name = arm + "_joint",
                   .child = arm,
                   .xyz = side == "left" ? "0.15 0.25 0" : "0.15 -0.25 0",
                   .type = "revolute",
                   .rest = "<limit lower=\"-0.5\" upper=\"0.5\" effort=\"0\" velocity=\"0\"/>"}) +
            link(side + "_link", inertial("1") + tyre("0.1")) +
            joint({.name = side, .child = side + "_link", .xyz = "-0.2 0 0", .parent = arm});
  }
  return text + more;
}

std::string foot(const std::string& name, const std::string& place) {
  return link(name, collision("<sphere radius=\"0.02\"/>")) +
         joint({.name = name + "_joint", .child = name, .xyz = place, .type = "fixed", .axis = ""});
}

TEST(BearingJoints, AreAcceptedIfTheRobotStandsWithoutThem) {
  const std::string rear = foot("rear", "-0.25 0 -0.08");
  const std::string front = foot("fl", "0.25 0.15 -0.08") + foot("fr", "0.25 -0.15 -0.08");
  EXPECT_THAT(refusal_of(robot_of(swing_arms(rear))), AllOf(HasSubstr("left_arm_joint"), HasSubstr("right_arm_joint")));
  EXPECT_EQ(refusal_of(robot_of(swing_arms(rear + front))), "accepted") << "as pmb2 does on its casters";
}

/// A body with `wheels` below a mast or lift on that joint.
std::string above(const std::string& type, const std::string& axis, const std::string& limits,
                  const std::string& place) {
  std::string text = link("base_link", inertial("10") + collision("<box size=\"0.6 0.4 0.1\"/>")) +
                     link("carriage", inertial("5")) +
                     joint({.name = "column",
                            .child = "carriage",
                            .xyz = place,
                            .type = type,
                            .axis = "<axis xyz=\"" + axis + "\"/>",
                            .rest = limits});
  for (const double x : {0.2, -0.2}) {
    for (const double y : {0.2, -0.2}) {
      const std::string name = "w" + std::to_string(text.size());
      text += link(name + "_link", inertial("1") + tyre("0.1")) +
              joint({.name = name, .child = name + "_link", .xyz = xyz(x, y, 0), .parent = "carriage"});
    }
  }
  return text;
}

/// Three supports: two wheels, and a foot on a slide with this effort limit in N.
std::string on_a_foot(const std::string& effort) {
  return two_wheels() + link("foot", inertial("1") + collision("<sphere radius=\"0.02\"/>")) +
         joint({.name = "leg",
                .child = "foot",
                .xyz = "0.25 0 -0.08",
                .type = "prismatic",
                .axis = "<axis xyz=\"0 0 1\"/>",
                .rest = "<limit lower=\"-0.3\" upper=\"0.3\" effort=\"" + effort + "\" velocity=\"1\"/>"});
}

TEST(BearingJoints, AreRefusedIfTheyAreTooWeakForAnEqualShareOfTheWeight) {
  EXPECT_THAT(refusal_of(robot_of(on_a_foot("40"))), HasSubstr("leg"));
  EXPECT_EQ(refusal_of(robot_of(on_a_foot("50"))), "accepted") << "13 kg on three";
}

TEST(BearingJoints, AreRefusedInALiftBelowTheBodyAndNotInASuspension) {
  const auto limits = [](const std::string& upper) {
    return "<limit lower=\"0\" upper=\"" + upper + "\" effort=\"1000\" velocity=\"0.1\"/>";
  };
  EXPECT_THAT(refusal_of(robot_of(above("prismatic", "0 0 1", limits("0.5"), "0 0 -0.3"))), HasSubstr("column"));
  EXPECT_EQ(refusal_of(robot_of(above("prismatic", "0 0 1", limits("0.05"), "0 0 -0.3"))), "accepted");
}

/// Two crossed pairs of arms, drawn as one chain from the upper deck to the carriage.
std::string scissor_between() {
  std::string text =
      above("revolute", "0 1 0", "<limit lower=\"-1\" upper=\"1\" effort=\"0\" velocity=\"1\"/>", "0 0 0");
  const std::string hinge = "<parent link=\"base_link\"/><child link=\"carriage\"/><origin xyz=\"0 0 0\"";
  const std::string lower = "<parent link=\"arm\"/><child link=\"carriage\"/><origin xyz=\"0.3 0 -0.3\"";
  text.replace(text.find(hinge), hinge.size(), lower);
  return text + link("arm", inertial("1")) + joint({.name = "scissor", .child = "arm", .xyz = "-0.2 0 -0.1"});
}

TEST(BearingJoints, AreRefusedInAScissorLiftBelowTheBodyAndAcceptedAboveIt) {
  EXPECT_THAT(refusal_of(robot_of(scissor_between())), AllOf(HasSubstr("Found: scissor;"), Not(HasSubstr("column"))))
      << "the carriage's own hinge is balanced";
  const std::string arms = link("arm", inertial("1")) + joint({.name = "scissor", .child = "arm", .xyz = "0 0 0.1"}) +
                           link("deck", inertial("1")) +
                           joint({.name = "deck_joint", .child = "deck", .xyz = "0.2 0 0.2", .parent = "arm"});
  EXPECT_EQ(refusal_of(robot_of(two_wheels() + foot("rear", "-0.25 0 -0.08") + arms)), "accepted");
}

TEST(BearingJoints, DoNotIncludeThoseOfAMastThatTilts) {
  for (const std::string type : {"revolute", "prismatic"}) {
    const std::string mast = link("mast", inertial("3") + collision("<box size=\"0.05 0.05 1\"/>", "xyz=\"0 0 0.5\"")) +
                             joint({.name = "tilt",
                                    .child = "mast",
                                    .type = type,
                                    .rest = "<limit lower=\"-1\" upper=\"1\" effort=\"50\" velocity=\"1\"/>"});
    EXPECT_EQ(refusal_of(robot_of(two_wheels() + foot("rear", "-0.25 0 -0.08") + mast)), "accepted") << type;
  }
}

/// Rocker, bogie and wheels of one side; the bogie carries the two rear wheels.
std::string rocker_bogie(const std::string& side, double y) {
  const auto free = [](const std::string& name, const std::string& place, const std::string& parent) {
    return link(name, inertial("1")) + joint({.name = name + "_joint", .child = name, .xyz = place, .parent = parent});
  };
  const std::string rocker = side + "_rocker", bogie = side + "_bogie";
  std::string text = free(rocker, xyz(0, y, 0.1), "base_link") + free(bogie, xyz(-0.2, 0, -0.05), rocker);
  for (const auto& [name, x, parent] :
       {std::tuple{side + "_front", 0.3, rocker}, {side + "_middle", 0.1, bogie}, {side + "_rear", -0.1, bogie}}) {
    text +=
        link(name + "_link", inertial("1") + tyre("0.1")) + joint({.name = name,
                                                                   .child = name + "_link",
                                                                   .xyz = xyz(x, 0, parent == rocker ? -0.1 : -0.05),
                                                                   .parent = parent});
  }
  return text;
}

TEST(BearingJoints, AreAcceptedIfTheyAreBalanced) {
  EXPECT_EQ(refusal_of(robot_of(base() + rocker_bogie("left", 0.25) + rocker_bogie("right", -0.25))), "accepted");
  // A front axle pivots about x, as a tractor's does.
  const std::string pivot =
      link("axle", inertial("1")) +
      joint({.name = "pivot", .child = "axle", .xyz = "0.4 0 0", .axis = "<axis xyz=\"1 0 0\"/>"});
  std::string front;
  for (const double y : {0.25, -0.25}) {
    const std::string name = y > 0 ? "fl" : "fr";
    front += link(name + "_link", inertial("1") + tyre("0.1")) +
             joint({.name = name, .child = name + "_link", .xyz = xyz(0, y, 0), .parent = "axle"});
  }
  EXPECT_EQ(refusal_of(robot_of(two_wheels() + pivot + front)), "accepted");
}

/// A caster's roller is not round enough for a wheel, but turns on its axle nevertheless.
TEST(BearingJoints, AreNotTheAxlesOfWhatIsNearlyRound) {
  const std::string roller = link("roller", inertial("0.2") + collision("<box size=\"0.07 0.04 0.07\"/>")) +
                             joint({.name = "axle", .child = "roller", .xyz = "-0.25 0 -0.065"});
  EXPECT_EQ(refusal_of(robot_of(two_wheels() + roller)), "accepted");
}

}  // namespace robot_control::tests
