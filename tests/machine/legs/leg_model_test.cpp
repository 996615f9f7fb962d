/// Real quadrupeds against their facts, FACTS.json read as the YAML that it is; and what is refused.

#include "machine/legs/leg_model.h"

#include <algorithm>
#include <cmath>

#include "machine/bodies/rigid_bodies.h"
#include "machine/legs/leg_chains.h"
#include "machine/legs/leg_dynamics.h"
#include "machine/legs/legs_corpus.h"
#include "machine/legs/lying_posture.h"
#include "machine/quadruped_urdf.h"
#include "support/matchers.h"
#include "support/message_of.h"

namespace robot_control::tests {

constexpr double kDigits = 1.5e-9;      // m, of the feet in FACTS.json, which has nine decimals
constexpr double kEffortDigits = 1e-5;  // N·m
constexpr double kMassDigits = 1e-5;    // kg

struct LegFacts : testing::TestWithParam<std::string> {
  void SetUp() override {
    if (quadrupeds().empty()) GTEST_SKIP() << kNoQuadrupeds;
    facts_ = quadruped_facts()[GetParam()];
    robot_ = legged_robot(GetParam());
  }
  static std::array<double, kLegsJoints> angles(const YAML::Node& check) {
    std::array<double, kLegsJoints> q{};
    for (std::size_t i = 0; i < kLegsJoints; ++i) q[i] = check["q"][i].as<double>();
    return q;
  }

  YAML::Node facts_;
  LegModel robot_;
};

TEST_P(LegFacts, IsTheSameRobotOnAFreeJointOfAnEmptyWorld) {
  RobotDescription description = legged_description(GetParam());
  description.text.insert(description.text.rfind("</robot>"),
                          "<link name=\"world\"/><joint name=\"free\" type=\"floating\"><parent link=\"world\"/><child "
                          "link=\"" +
                              robot_.base_link + "\"/><origin xyz=\"1 2 3\" rpy=\"0 1 0\"/></joint>");
  const LegModel free = read_legs(description, {}, {});
  EXPECT_EQ(free.base_link, robot_.base_link);
  EXPECT_EQ(free.centre_of_gravity_base, robot_.centre_of_gravity_base);
  EXPECT_EQ(free.parts(), robot_.parts());
  EXPECT_EQ(free.notes.size(), robot_.notes.size() + 1);
}

TEST_P(LegFacts, FindsItsLegsByPlace) {
  EXPECT_NEAR(robot_.mass, facts_["total_mass"].as<double>(), kMassDigits);
  for (const YAML::Node& leg : facts_["legs"]) {
    const auto place = leg["place"].as<std::string>();
    std::size_t i = 0;
    while (i < kLegs && place != name_of(static_cast<LegPlace>(i))) ++i;
    ASSERT_LT(i, kLegs) << place;
    for (std::size_t j = 0; j < kLegJoints; ++j)
      EXPECT_EQ(robot_.joints[3 * i + j].name, leg["joints"][j].as<std::string>()) << place;
    EXPECT_NEAR(robot_.legs[i].foot_radius, leg["foot_radius"].as<double>(), kDigits) << place;
  }
}

TEST_P(LegFacts, PutsItsFeetAndItsCentreOfGravityWhereTheFactsAre) {
  const LegDynamics dynamics(robot_);
  for (const YAML::Node& check : facts_["checks"]) {
    LeggedMotion motion{.angles = angles(check)};
    LeggedEquations equations;
    dynamics.step(motion, equations);
    for (std::size_t leg = 0; leg < kLegs; ++leg) {
      const Eigen::Vector3d foot = robot_.legs[leg].kinematics.position(LegModel::angles_of(motion.angles, leg));
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(foot[static_cast<Eigen::Index>(axis)], check["feet"][leg][axis].as<double>(), kDigits) << leg;
      }
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(equations.centre_of_gravity[static_cast<Eigen::Index>(axis)], check["com"][axis].as<double>(), 2e-8);
    }
  }
}

TEST_P(LegFacts, HoldsItsLegsWithTheEffortsOfTheFacts) {
  const LegDynamics dynamics(robot_);
  for (const YAML::Node& check : facts_["checks"]) {
    LeggedEquations equations;
    dynamics.step({.angles = angles(check)}, equations);
    for (std::size_t i = 0; i < kLegsJoints; ++i) {
      EXPECT_NEAR(equations.bias[static_cast<Eigen::Index>(6 + i)], check["gravity_effort"][i].as<double>(),
                  kEffortDigits)
          << robot_.joints[i].name;
    }
  }
}

std::vector<std::string> real_ones() {
  std::vector<std::string> names = legged_robots();
  names.erase(names.begin());
  return names.empty() ? std::vector<std::string>{"absent"} : names;
}

INSTANTIATE_TEST_SUITE_P(Robots, LegFacts, testing::ValuesIn(real_ones()), robot_name);

TEST(LegModel, BendsTheKneesOfAnymalTowardsTheMiddleWhereTheRangesLeaveBothSides) {
  if (quadrupeds().empty()) GTEST_SKIP() << kNoQuadrupeds;
  const LegModel derived = legged_robot("anymal_c");
  const LegModel outwards = legged_robot("anymal_c", {.knee_bend = KneeBend::kOutwards});
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const double middle = leg < 2 ? -1 : 1;
    EXPECT_EQ(derived.legs[leg].kinematics.geometry().bend, middle) << leg;
    EXPECT_EQ(outwards.legs[leg].kinematics.geometry().bend, -middle) << leg;
  }
}

TEST(LegModel, BendsOneSidedKneesAsTheirRangesDo) {
  const LegModel robot = legged_robot("quadbot");
  for (const Leg& leg : robot.legs) EXPECT_EQ(leg.kinematics.geometry().bend, -1);
}

LegChains chains_of(const LegModel& robot) {
  LegChains chains{};
  const auto& bodies = robot.bodies->bodies;
  for (std::size_t i = 0; i < kLegsJoints; ++i) {
    const auto moved =
        std::ranges::find(bodies, robot.joints[i].name, [](const RigidBody& body) { return body.joint.name; });
    chains[i / kLegJoints][i % kLegJoints] = static_cast<std::size_t>(moved - bodies.begin());
  }
  return chains;
}

TEST(LegModel, LiesOnItsBodyAlone) {
  for (const std::string& name : legged_robots()) {
    const LegModel robot = legged_robot(name);
    const Belly belly = belly_of(*robot.bodies, chains_of(robot));
    EXPECT_EQ(belly.height, robot.belly) << name;
    // The body of go2 has its lowest point in front of its centre of gravity.
    EXPECT_NEAR(std::atan2(belly.down.x(), -belly.down.z()), name == "go2" ? -0.104 : 0, 0.002) << name;
    for (const Leg& leg : robot.legs) {
      const LegGeometry& geometry = leg.kinematics.geometry();
      const Eigen::Quaterniond hip(Eigen::AngleAxisd(geometry.sign[0] * leg.lying[0], Eigen::Vector3d::UnitX()));
      const Eigen::Quaterniond thigh(Eigen::AngleAxisd(geometry.sign[1] * leg.lying[1], Eigen::Vector3d::UnitY()));
      const Eigen::Vector3d knee = geometry.hip + hip * (geometry.upper + thigh * geometry.lower);
      EXPECT_LE(belly.down.dot(leg.kinematics.position(leg.lying)) + leg.foot_radius, belly.depth) << name;
      EXPECT_LE(belly.down.dot(knee), belly.depth) << name;
      for (std::size_t i = 0; i < kLegJoints; ++i) {
        const JointRange& range = leg.kinematics.geometry().range[i];
        EXPECT_GE(leg.lying[static_cast<Eigen::Index>(i)], range.lower) << name;
        EXPECT_LE(leg.lying[static_cast<Eigen::Index>(i)], range.upper) << name;
      }
    }
  }
}

struct LegRefusals : testing::Test {
  std::string refusal(const std::string& content, const LegParameters& legs = {}) {
    return message_of<RobotError>([&] { read_legs(robot_of(content), {}, legs); }, "accepted");
  }
  static std::string without(std::string text, const std::string& part) { return replaced(std::move(text), part, ""); }
  static std::string replaced(std::string text, const std::string& part, const std::string& by) {
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + by.size()))
      text.replace(at, part.size(), by);
    return text;
  }
  std::string body_ = link("trunk", inertial("6") + collision("<box size=\"0.4 0.2 0.1\"/>"));
  std::string legs_ = leg("a", 0.19, -0.05) + leg("b", 0.19, 0.05) + leg("c", -0.19, -0.05) + leg("d", -0.19, 0.05);
};

TEST_F(LegRefusals, AcceptTheHealthyRobotUnderAnyNames) {
  EXPECT_EQ(refusal(body_ + legs_), "accepted");
}

TEST_F(LegRefusals, NameTheNumberOfLegs) {
  const std::string two = refusal(body_ + leg("a", 0.19, -0.05) + leg("b", 0.19, 0.05));
  EXPECT_THAT(two, HasSubstr("2 legs found (to a_calf, b_calf), but a quadruped has four"));
  EXPECT_THAT(refusal(body_ + legs_ + leg("e", 0, 0.05) + leg("f", 0, -0.05)), HasSubstr("6 legs found"));
}

TEST_F(LegRefusals, NameTwoLegsAtOneCorner) {
  const std::string text =
      refusal(body_ + leg("a", 0.19, -0.05) + leg("b", 0.19, -0.15) + leg("c", -0.19, -0.05) + leg("d", -0.19, 0.05));
  EXPECT_THAT(text, HasSubstr("<link name=\"b_calf\">: this leg and that to a_calf are both front_right"));
}

TEST_F(LegRefusals, NameAJointWithoutLimits) {
  EXPECT_THAT(refusal(body_ + replaced(legs_, "effort=\"35\"", "effort=\"0\"")),
              HasSubstr("_calf_joint\">: the leg joint has no effort limit"));
  EXPECT_THAT(refusal(body_ + replaced(legs_, "velocity=\"20\"", "velocity=\"0\"")),
              HasSubstr("_calf_joint\">: the leg joint has no velocity limit"));
}

TEST_F(LegRefusals, NameAnAxisThatIsFarFromThatOfALeg) {
  const std::string off = replaced(legs_, R"(<axis xyz="0 1 0"/>)", R"(<axis xyz="0.12187 0.99255 0"/>)");
  EXPECT_THAT(refusal(body_ + off), HasSubstr("a_thigh_joint\">: its axis is 7° off the lateral (y) axis of trunk"));
  const std::string hips = replaced(legs_, R"(<axis xyz="1 0 0"/>)", R"(<axis xyz="0.99619 0 0.08716"/>)");
  EXPECT_THAT(refusal(body_ + hips), HasSubstr("a_hip_joint\">: its axis is 5° off the lengthwise (x) axis of trunk"));
  EXPECT_TRUE(has_legs(read_moving_bodies(robot_of(body_ + off))));
}

TEST_F(LegRefusals, NameLinksWithoutInertial) {
  const std::string weightless = without(legs_, inertial("0.5", kSmall));
  EXPECT_THAT(refusal(body_ + weightless),
              HasSubstr("almost a quadruped: these links have no <inertial> and count as fixed: a_calf, a_hip, "
                        "a_thigh, b_calf"));
  EXPECT_TRUE(has_legs(read_moving_bodies(robot_of(body_ + weightless))));
  EXPECT_TRUE(
      has_legs(read_moving_bodies(robot_of(link("trunk", collision("<box size=\"0.4 0.2 0.1\"/>")) + weightless))));
}

TEST_F(LegRefusals, NameWhatKeepsFourLimbsFromBeingLegs) {
  const std::string hips = replaced(legs_, R"(<axis xyz="1 0 0"/>)", R"(<axis xyz="0 0 1"/>)");
  EXPECT_THAT(refusal(body_ + hips),
              HasSubstr("almost a quadruped: the hip's axis is z, but at zero angles, the axes of a leg are x, y"));
  EXPECT_TRUE(has_legs(read_moving_bodies(robot_of(body_ + hips))));
}

TEST_F(LegRefusals, NameABodyWithoutAShape) {
  const std::string hips = without(legs_, collision("<sphere radius=\"0.04\"/>"));
  EXPECT_THAT(refusal(link("trunk", inertial("6")) + hips),
              HasSubstr("<link name=\"trunk\">: a robot on legs lies on its body, but this has no shape"));
}

TEST_F(LegRefusals, NameARangeThatLooksLikeDegrees) {
  EXPECT_THAT(refusal(body_ + replaced(legs_, R"(lower="-2.7" upper="-0.9")", R"(lower="-155" upper="-52")")),
              HasSubstr("_calf_joint\">: its range of -155 to -52 rad looks like degrees"));
  EXPECT_EQ(refusal(body_ + replaced(legs_, R"("-9.42" upper="9.42")", R"("-10000" upper="10000")")), "accepted");
}

TEST_F(LegRefusals, NameAFootWithoutAShape) {
  EXPECT_THAT(refusal(body_ + without(legs_, collision("<sphere radius=\"0.02\"/>"))),
              HasSubstr("_calf\">: the leg that ends here has no shape"));
}

TEST_F(LegRefusals, NameAWheelOnALeg) {
  std::string wheels;
  for (const char* name : {"a", "b", "c", "d"}) {
    const std::string wheel = std::string(name) + "_wheel";
    wheels += link(wheel, inertial("0.5") + collision("<sphere radius=\"0.05\"/>")) +
              joint({.name = wheel + "_joint",
                     .child = wheel,
                     .xyz = "0 0 -0.21",
                     .type = "continuous",
                     .axis = "<axis xyz=\"0 1 0\"/>",
                     .rest = "<limit effort=\"5\" velocity=\"20\"/>",
                     .parent = std::string(name) + "_calf"});
  }
  EXPECT_THAT(refusal(body_ + legs_ + wheels), HasSubstr("a_wheel_joint\">: it is a fourth moving joint of a leg"));
}

TEST_F(LegRefusals, NameAnotherJointThatMoves) {
  const std::string arm =
      link("arm", inertial("1")) + joint({.name = "arm_joint",
                                          .child = "arm",
                                          .xyz = "0 0 0.1",
                                          .type = "revolute",
                                          .axis = "<axis xyz=\"0 0 1\"/>",
                                          .rest = "<limit lower=\"-1\" upper=\"1\" effort=\"5\" velocity=\"2\"/>",
                                          .parent = "trunk"});
  EXPECT_THAT(refusal(body_ + legs_ + arm),
              HasSubstr("<joint name=\"arm_joint\">: it moves, but is not part of a leg"));
}

TEST_F(LegRefusals, NameAKneeThatCannotBendAsAsked) {
  EXPECT_THAT(refusal(body_ + legs_, {.knee_bend = KneeBend::kForward}),
              HasSubstr("robot.knee_bend requires this knee to point forward, but its range does not allow this"));
}

TEST_F(LegRefusals, BendTheKneeToTheSideOnWhichTheThighLetsTheLegStand) {
  std::string both = replaced(legs_, R"(lower="-2.7" upper="-0.9")", R"(lower="-2.7" upper="2.7")");
  const auto bends = [&] {
    std::string text;
    for (const Leg& leg : read_legs(robot_of(body_ + both), {}, {}).legs)
      text += leg.kinematics.geometry().bend > 0 ? "+" : "-";
    return text;
  };
  EXPECT_EQ(bends(), "--++") << "towards the middle";
  both = replaced(both, R"(lower="-9.42" upper="9.42")", R"(lower="0.2" upper="3")");
  EXPECT_EQ(bends(), "----") << "a thigh that turns backward alone";
}

TEST_F(LegRefusals, FindMirroredLegsWithFlippedAxes) {
  std::string flipped = replaced(legs_, "<axis xyz=\"0 1 0\"/>", "<axis xyz=\"0 -1 0\"/>");
  flipped = replaced(flipped, "lower=\"-2.7\" upper=\"-0.9\"", "lower=\"0.9\" upper=\"2.7\"");
  const LegModel robot = read_legs(robot_of(body_ + flipped), {}, {});
  const LegModel straight = read_legs(robot_of(body_ + legs_), {}, {});
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const LegAngles angles(0.2, 0.7, -1.4);
    EXPECT_LE(
        (robot.legs[leg].kinematics.position({0.2, -0.7, 1.4}) - straight.legs[leg].kinematics.position(angles)).norm(),
        1e-15);
  }
}

TEST(LegModel, HasRotorsOfTheRobotsSizeUnlessTheyAreGiven) {
  const LegModel quadbot = legged_robot("quadbot");
  EXPECT_NEAR(quadbot.rotor_inertia, 0.01, 1e-9);
  EXPECT_EQ(quadbot.joints[5].rotor_inertia, quadbot.rotor_inertia);
  EXPECT_NEAR(usual_rotor_inertia(8 * quadbot.mass, 2 * quadbot.leg_length()), 0.32, 1e-7) << "twice as large";
  EXPECT_EQ(legged_robot("quadbot", {.leg_rotor_inertia = 0.003}).rotor_inertia, 0.003);
}

TEST(HasLegs, IsTrueForQuadrupedsAndFalseForRobotsOnWheels) {
  for (const std::string& name : legged_robots())
    EXPECT_TRUE(has_legs(read_moving_bodies(legged_description(name)))) << name;
  if (corpus().empty()) return;
  for (const auto& folder : std::filesystem::directory_iterator(corpus())) {
    const std::filesystem::path file = folder.path() / "robot.urdf";
    if (!std::filesystem::exists(file)) continue;
    EXPECT_FALSE(has_legs(read_moving_bodies(load_description(file.string())))) << file;
  }
}

}  // namespace robot_control::tests
