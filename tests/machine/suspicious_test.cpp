/// A value of a file that cannot be intended is noted as suspicious.

#include <cmath>

#include "machine/random_text.h"
#include "machine/urdf_text.h"
#include "support/matchers.h"
#include "support/temporary_folder.h"

namespace robot_control::tests {

struct Made {
  double unit = 1;   ///< m, factor on all lengths
  double grain = 1;  ///< kg, factor on all masses
  double radius = 0.1, base = 0.5, high = 0, mass = 10, wheel_mass = 1;
  bool casters = true;
};

std::string made(const Made& m) {
  const auto mass = [&](double kilograms, double size) {
    const double inertia = kilograms * m.grain * std::pow(size * m.unit, 2) / 6;
    const std::string i = "\"" + std::to_string(inertia) + "\"";
    return "<inertial><origin xyz=\"0 0 " + metres(size == m.base ? m.high : 0) + "\"/><mass value=\"" +
           std::to_string(kilograms * m.grain) + "\"/><inertia ixx=" + i + " iyy=" + i + " izz=" + i +
           " ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial>";
  };
  const double u = m.unit;
  std::string text =
      link("base_link",
           mass(m.mass, m.base) + collision("<box size=\"" + xyz(m.base * u, m.base * 0.8 * u, m.radius * u) + "\"/>"));
  for (const double side : {1.0, -1.0}) {
    const std::string name = side > 0 ? "left" : "right";
    text += link(name + "_link",
                 mass(m.wheel_mass, m.radius) + collision("<cylinder radius=\"" + metres(m.radius * u) +
                                                              "\" length=\"" + metres(0.3 * m.radius * u) + "\"/>",
                                                          "rpy=\"1.5707963267948966 0 0\"")) +
            joint({.name = name, .child = name + "_link", .xyz = xyz(0, side * m.base / 2 * u, 0)});
  }
  for (const double end : {1.0, -1.0}) {
    const std::string name = end > 0 ? "front" : "back";
    const double r = m.radius / 3;
    if (m.casters) {
      text += link(name, collision("<sphere radius=\"" + metres(r * u) + "\"/>")) +
              joint({.name = name + "_joint",
                     .child = name,
                     .xyz = xyz(end * 0.4 * m.base * u, 0, (r - m.radius) * u),
                     .type = "fixed",
                     .axis = ""});
    }
  }
  return text;
}

std::string suspicion(const std::string& text) {
  return notes_of(read_drive_train(robot_of(text), {}), RobotNote::Kind::kSuspicious);
}

std::string driven_by(const std::string& left, const std::string& right) {
  const auto limit = [](const std::string& text) { return text.empty() ? "" : "<limit " + text + "/>"; };
  return suspicion(base() + wheel("left", "0 0.25 0", "0.1", limit(left)) +
                   wheel("right", "0 -0.25 0", "0.1", limit(right)));
}

TEST(Suspicious, AVelocityLimitThatNoWheelReachesMayBeInDegrees) {
  const std::string speed = "effort=\"5\" velocity=\"573\"";
  EXPECT_THAT(driven_by(speed, speed),
              HasSubstr("573 rad/s is 57.3 m/s at its rim: check whether it is in degrees per second"));
  const std::string slow = "effort=\"5\" velocity=\"30\"";
  EXPECT_THAT(driven_by(slow, slow), Not(HasSubstr("at its rim")));
}

TEST(Suspicious, LimitsOfTheSidesThatDiffer) {
  const std::string slow = "effort=\"5\" velocity=\"10\"";
  EXPECT_THAT(driven_by(slow, "effort=\"5\" velocity=\"20\""), HasSubstr("those of left 5 N·m and 10 rad/s"));
  EXPECT_THAT(driven_by(slow, "effort=\"4\" velocity=\"10\""), HasSubstr("its limits are 4 N·m and 10 rad/s"));
  EXPECT_THAT(driven_by(slow, ""), HasSubstr("no known speed"));
  EXPECT_THAT(driven_by(slow, slow), Not(HasSubstr("its limits are")));
}

TEST(Suspicious, AnOriginOfMoreThanAWholeTurnMayBeInDegrees) {
  const std::string text = base() + wheel("left", "0 0.25 0") + wheel("right", "0 -0.25 0");
  const auto with = [&](const std::string& rpy) {
    return suspicion(text + link("mast", inertial("0.1")) +
                     joint({.name = "mast_joint", .child = "mast", .type = "fixed", .axis = "", .rpy = rpy}));
  };
  EXPECT_THAT(with("0 0 -90"), HasSubstr("<joint name=\"mast_joint\">: <origin rpy=\"0 0 -90\"> is more than a whole"));
  EXPECT_THAT(with("0 0 6.2831853"), Not(HasSubstr("rpy")));
}

/// A healthy robot with an arm of 2 kg at 0.5 m on a joint with this effort limit.
std::string arm_of(const std::string& effort) {
  return suspicion(
      two_wheels() +
      link("arm", "<inertial><origin xyz=\"0.5 0 0\"/><mass value=\"2\"/><inertia " + kBall + "/></inertial>") +
      joint({.name = "shoulder",
             .child = "arm",
             .type = "revolute",
             .rest = "<limit lower=\"-1\" upper=\"1\" effort=\"" + effort + "\" velocity=\"1\"/>"}));
}

TEST(Suspicious, AHeldJointThatIsTooWeakForItsLoad) {
  EXPECT_THAT(arm_of("9.7"),
              HasSubstr("<joint name=\"shoulder\">: its effort limit of 9.7 N·m is below its load of 9.81"));
  EXPECT_THAT(arm_of("9.9"), Not(HasSubstr("shoulder")));
}

TEST(Suspicious, AJointThatNothingHolds) {
  EXPECT_THAT(arm_of("0"), HasSubstr("<joint name=\"shoulder\">: no effort limit above zero"));
}

TEST(Suspicious, OuterWheelsOfADeepMiddlePairThatDoNotDrive) {
  const auto six = [](double deep) {
    std::string text = base();
    for (const double y : {0.25, -0.25}) {
      for (const double x : {0.3, 0.0, -0.3}) {
        text += wheel((y > 0 ? "left_" : "right_") + std::to_string(static_cast<int>(10 * x + 5)),
                      xyz(x, y, x == 0 ? -deep : 0));
      }
    }
    return suspicion(text);
  };
  EXPECT_THAT(six(0.01), AllOf(HasSubstr("lowest point is 10 mm above theirs: assumed passive, only 2 wheels drive"),
                               HasSubstr("robot.left_wheel_joints")));
  EXPECT_THAT(six(-0.01), HasSubstr("only 4 wheels drive"));
  EXPECT_THAT(six(0), Not(HasSubstr("assumed passive")));
}

std::string base_of(double radius, double wheel_base) {
  Made m;
  m.radius = radius;
  m.base = wheel_base;
  m.mass = 100;
  m.wheel_mass = 10;
  return made(m);
}

Made healthy(Random& random) {
  Made m;
  m.radius = between(random, 0.03, 0.25);
  m.base = m.radius * between(random, 3, 6);
  m.mass = between(random, 100, 500) * m.base * m.base * m.radius;
  m.wheel_mass = m.mass / 15;
  return m;
}

/// Every healthy robot in which `change` spoils one thing is suspicious for `reason`.
template <class Change>
void expect_suspicion(unsigned seeds, Change change, const std::string& reason) {
  for (unsigned seed = 0; seed < seeds; ++seed) {
    Random random(seed);
    Made m = healthy(random);
    change(m, random);
    EXPECT_THAT(suspicion(made(m)), HasSubstr(reason)) << seed;
  }
}

TEST(Suspicious, NothingOfHealthyRobots) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    Random random(seed);
    EXPECT_EQ(suspicion(made(healthy(random))), "") << seed;
  }
}

TEST(Suspicious, LengthsInMillimetres) {
  expect_suspicion(
      40, [](Made& m, Random&) { m.unit = 1000; }, "millimetres");
}

TEST(Suspicious, MassesInGrams) {
  expect_suspicion(
      40, [](Made& m, Random&) { m.grain = 1000; }, "grams");
}

TEST(Suspicious, ABaseThatWeighsNextToNothing) {
  expect_suspicion(
      20, [](Made& m, Random& random) { m.mass = between(random, 0.001, 0.1) * m.wheel_mass; },
      "<link name=\"base_link\">: it and the links fixed to it weigh only");
}

TEST(Suspicious, WheelsOfSixtyCentimetresAndMoreThatStandCloseTogether) {
  for (const double radius : {0.6, 0.7, 1.0, 1.6}) {
    for (const double base : {0.1, 0.2, 0.5, 1.5}) {
      EXPECT_THAT(suspicion(base_of(radius, base)), HasSubstr("radius")) << radius << " " << base;
    }
  }
}

TEST(Suspicious, ACentreOfGravityThatTipsTheRobotWhenItBrakes) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    Random random(seed);
    Made m = healthy(random);
    EXPECT_THAT(suspicion(made(m)), Not(HasSubstr("tips"))) << seed;
    // The supports stand 0.4 of the base in front and behind: with its centre c above the floor it tips at g 0.4 base /
    // c.
    m.high = 0.4 * m.base * 9.81 / between(random, 0.1, 0.7) * (m.mass + 2 * m.wheel_mass) / m.mass;
    EXPECT_THAT(suspicion(made(m)), AllOf(HasSubstr("centre of gravity"), HasSubstr("tips"))) << seed;
  }
}

TEST(Suspicious, ARobotThatOnlyItsDriveWheelsCarry) {
  expect_suspicion(
      20, [](Made& m, Random&) { m.casters = false; }, "supports it on one side of its centre of gravity");
}

TEST(Suspicious, NothingOfARobotWhoseSpringsLetItStandOtherwise) {
  std::string text = made({.casters = false});
  for (const std::string side : {"left", "right"}) {
    const std::string hung = "<parent link=\"base_link\"/><child link=\"" + side + "_link\"/>";
    const std::size_t at = text.find(hung);
    ASSERT_NE(at, std::string::npos);
    text.replace(at, hung.size(), "<parent link=\"" + side + "_spring\"/><child link=\"" + side + "_link\"/>");
    text += link(side + "_spring", inertial("0.5")) +
            joint({.name = side + "_hub",
                   .child = side + "_spring",
                   .type = "prismatic",
                   .axis = "<axis xyz=\"0 0 1\"/>",
                   .rest = "<limit lower=\"-0.05\" upper=\"0.05\" effort=\"500\" velocity=\"1\"/>"});
  }
  EXPECT_THAT(suspicion(text), Not(HasSubstr("carries it")));
}

TEST(Suspicious, WheelsThatCannotMoveTheRobot) {
  const auto limited = [](double effort, double friction) {
    std::string text = made({});
    const std::string axis = "<axis xyz=\"0 1 0\"/>";
    EXPECT_NE(text.find(axis), std::string::npos);
    for (std::size_t at = text.find(axis); at != std::string::npos; at = text.find(axis, at + 1)) {
      text.insert(at, "<limit effort=\"" + std::to_string(effort) + "\" velocity=\"10\"/><dynamics friction=\"" +
                          std::to_string(friction) + "\"/>");
      at = text.find(axis, at);
    }
    return text;
  };
  EXPECT_EQ(suspicion(limited(2, 0.1)), "");
  EXPECT_THAT(suspicion(limited(0.002, 0)), HasSubstr("accelerate the robot by no more than"));
  EXPECT_THAT(suspicion(limited(2, 2)), HasSubstr("accelerate the robot by no more than 0 m/s²"));
}

TEST(Suspicious, AWorldThatTheRobotIsFixedToFarAway) {
  const auto world = [](double x) {
    return link("world", "") +
           joint({.name = "fix",
                  .child = "base_link",
                  .xyz = xyz(x, 0, 0),
                  .type = "fixed",
                  .axis = "",
                  .parent = "world"}) +
           made({});
  };
  EXPECT_EQ(suspicion(world(0.5)), "");
  EXPECT_THAT(suspicion(world(50)), HasSubstr("<link name=\"world\">: it is 50"));
}

struct Files : testing::Test {
  RobotDescription with(const std::string& text) {
    return load_description(folder_.write("r.urdf", robot_of(text).text).string());
  }
  TemporaryFolder folder_;
};

std::string shell(const std::string& file, const std::string& kind = "collision") {
  return "<" + kind + "><geometry><mesh filename=\"" + file + "\"/></geometry></" + kind + ">";
}

std::string part(const std::string& name, const std::string& content, const std::string& at = "0 0 0.2") {
  return link(name, content) + joint({.name = name + "_joint", .child = name, .xyz = at, .type = "fixed", .axis = ""});
}

std::string casters() {
  return part("front", collision("<sphere radius=\"0.02\"/>"), "0.25 0 -0.08") +
         part("back", collision("<sphere radius=\"0.02\"/>"), "-0.25 0 -0.08");
}

constexpr const char* kTetrahedron = "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0 0 0.1\n";
constexpr const char* kItsFaces = "f 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n";

TEST_F(Files, PointsOfAMeshThatAreNotANumberAreNoted) {
  const std::string solid =
      "solid s\n facet normal 0 0 1\n outer loop\n vertex 0 0 0\n vertex 0.1 0 0\n vertex 0 0.1 0\n endloop\n "
      "endfacet\n"
      " facet normal 0 0 1\n outer loop\n vertex 0 0 0.1\n vertex nan 0 0\n vertex 0 inf 0\n endloop\n "
      "endfacet\nendsolid s\n";
  folder_.write("part.stl", solid);
  const DriveTrain robot = read_drive_train(with(two_wheels() + casters() + part("top", shell("part.stl"))), {});
  EXPECT_THAT(notes_of(robot, RobotNote::Kind::kSuspicious),
              AllOf(HasSubstr("<link name=\"top\">"), HasSubstr("part.stl"), HasSubstr("2 points")));
}

TEST_F(Files, MissingVisualMeshesAreNotedAndNothingElse) {
  folder_.write("there.obj", std::string(kTetrahedron) + kItsFaces);
  const std::string text = two_wheels() + casters() + part("top", shell("nowhere.dae", "visual")) +
                           part("lid", shell("there.obj", "visual"));
  const std::string notes = notes_of(read_drive_train(with(text), {}), RobotNote::Kind::kSuspicious);
  EXPECT_THAT(notes, AllOf(HasSubstr("<link name=\"top\">"), HasSubstr("nowhere.dae"), Not(HasSubstr("there.obj"))));
}

TEST_F(Files, AMissingCollisionMeshOfWhatTouchesNothingIsNoted) {
  const DriveTrain robot =
      read_drive_train(with(two_wheels() + casters() + part("top", shell("package://nowhere/top.stl"))), {});
  EXPECT_THAT(notes_of(robot, RobotNote::Kind::kSuspicious),
              AllOf(HasSubstr("<link name=\"top\">"), HasSubstr("top.stl"), HasSubstr("ignored")));
}

// Two wheels and a missing caster would fall over, and nothing would tell why.
TEST_F(Files, AMissingCollisionMeshOnWhichTheRobotStandsIsRefused) {
  const std::string text = link("base_link", "<inertial><origin xyz=\"-0.05 0 0\"/><mass value=\"10\"/><inertia " +
                                                 kBall + "/></inertial>" + collision("<box size=\"0.6 0.4 0.1\"/>")) +
                           wheel("left", "0 0.25 0") + wheel("right", "0 -0.25 0") +
                           part("skid", shell("skid.stl"), "-0.25 0 -0.1");
  EXPECT_THAT(refusal_of(with(text)), AllOf(HasSubstr("<link name=\"skid\">"), HasSubstr("skid.stl")));
}

TEST_F(Files, AMissingCollisionMeshOfAWheelIsRefused) {
  const std::string text = base() + casters() + wheel("left", "0 0.25 0") +
                           link("right_link", inertial("1") + shell("nowhere.stl")) +
                           joint({.name = "right", .child = "right_link", .xyz = "0 -0.25 0"});
  EXPECT_THAT(refusal_of(with(text)), AllOf(HasSubstr("<link name=\"right_link\">"), HasSubstr("nowhere.stl")));
}

/// An arm ahead of the robot whose tip wheel ends `gap` m above the ground; `axis` is that of its shoulder.
std::string tip_wheel(double gap, const std::string& axis, const std::string& rest) {
  return made({}) + link("arm", inertial("0.5")) +
         joint({.name = "shoulder", .child = "arm", .xyz = "0.3 0 0", .type = "revolute", .axis = axis, .rest = rest}) +
         link("tip", inertial("0.1") + tyre("0.03")) +
         joint({.name = "tip_joint", .child = "tip", .xyz = xyz(0.1, 0, 0.03 - 0.1 + gap), .parent = "arm"});
}

TEST(Suspicious, AnArmWhoseTipWheelCountsAsACastersBecauseNothingHoldsIt) {
  const std::string lateral = "<axis xyz=\"0 1 0\"/>",
                    motor = R"(<limit lower="-1" upper="1" effort="20" velocity="1"/>)";
  const auto noted =
      AllOf(HasSubstr("<joint name=\"shoulder\">: it has an effort limit of 20 N·m, but no motor holds it"),
            HasSubstr("the wheel of tip_joint"), HasSubstr("more than 30 mm above the ground"));
  EXPECT_THAT(suspicion(tip_wheel(0.002, lateral, motor)), noted);
  EXPECT_THAT(suspicion(tip_wheel(0.031, lateral, motor)), Not(HasSubstr("no motor holds it, because")));
  EXPECT_THAT(suspicion(tip_wheel(0.002, "<axis xyz=\"0 0 1\"/>", motor)), Not(HasSubstr("shoulder")));
  EXPECT_THAT(suspicion(tip_wheel(0.002, lateral, R"(<limit lower="-1" upper="1" effort="0" velocity="1"/>)")),
              Not(HasSubstr("no motor holds it, because")));
}

}  // namespace robot_control::tests
