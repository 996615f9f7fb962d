/// Every refusal names the file, the element and the remedy.

#include "machine/urdf_text.h"
#include "machine/wheeled/drive_train.h"
#include "support/matchers.h"
#include "support/message_of.h"
#include "support/quiet_refusal.h"
#include "support/robots/diffbot_urdf.h"

namespace robot_control::tests {

const std::string kFirstJoint = "<joint name=\"left_wheel_joint\"";
const std::string kLeftLink = "<link name=\"left_wheel_link\">";

std::string refusal(const RobotDescription& description, const DriveTrainParameters& parameters = {}) {
  return quiet_refusal<RobotError>([&] { read_drive_train(description, parameters); });
}

DriveTrainParameters named() {
  DriveTrainParameters parameters;
  parameters.left_wheel_joints = {"left_wheel_joint"};
  parameters.right_wheel_joints = {"right_wheel_joint"};
  return parameters;
}

auto names(const std::string& element, const std::string& what) {
  return AllOf(HasSubstr("diffbot.urdf"), HasSubstr(element), HasSubstr(what));
}

struct Spoilt {
  const char* what;
  RobotDescription description;
  std::vector<std::string> names;
};

const std::string kWheelShape = "<collision>\n      <origin rpy=\"1.5707963267948966 0 0\"/>\n      ";
const std::string kRing = link("a", "") + link("b", "") +
                          joint({.name = "ab", .child = "b", .type = "fixed", .parent = "a"}) +
                          joint({.name = "ba", .child = "a", .type = "fixed", .parent = "b"});
const std::string kLossy =
    link("part", inertial("1")) + joint({.name = "p", .child = "part", .rest = "<dynamics friction=\"1e300\"/>"});

TEST(RobotRefusals, NameFileElementAndRemedyOfWhatIsSpoilt) {
  const std::vector<Spoilt> cases{
      {"XML, with its line",
       diffbot_with("<robot", "<link name=\"base_link\">", "<link name=\"base_link\""),
       {"diffbot.urdf", "XML", "line "}},
      {"an empty text", {"", "diffbot.urdf"}, {"diffbot.urdf", "XML", "document empty. "}},
      {"no robot", {"<mujoco/>", "diffbot.urdf"}, {"diffbot.urdf", "<robot>", "element not found"}},
      {"what urdfdom refuses, in its words",
       diffbot_with(kFirstJoint, "<child link=\"left_wheel_link\"/>", "<child link=\"nowhere\"/>"),
       {"diffbot.urdf", "<robot>", "nowhere"}},
      {"no wheels",
       robot_of(link("a", inertial("1"))),
       {"r.urdf", "<robot>", "no drive wheels found.\nFound: no joint turns"}},
      {"wheels on two axles",
       diffbot_with(kFirstJoint, "<origin xyz=\"0 0.25 0\"/>", "<origin xyz=\"0.1 0.25 0\"/>"),
       {"diffbot.urdf", "left_wheel_joint", "one axle"}},
      {"a negative mass",
       diffbot_with("<robot", "<mass value=\"3.45\"/>", "<mass value=\"-3.45\"/>"),
       {"diffbot.urdf", "battery_link", "mass"}},
      {"a base without a mass",
       robot_of(link("base_link", "") + wheel("left", "0 0.25 0") + wheel("right", "0 -0.25 0")),
       {"<link name=\"base_link\">", "has a mass"}},
      {"a floating joint",
       diffbot_with("<joint name=\"imu_joint\"", "fixed", "floating"),
       {"diffbot.urdf", "imu_joint", "floating"}},
      {"an unknown type",
       diffbot_with("<joint name=\"imu_joint\"", "fixed", "screwed"),
       {"diffbot.urdf", "imu_joint", "type=\"screwed\" is unknown", "line ", "prismatic"}},
      {"two outermost elements",
       {robot_of(two_wheels()).text + robot_of(two_wheels()).text, "r.urdf"},
       {"a second outermost element"}},
      {"two root links", robot_of(two_wheels() + link("lonely", "")), {"lonely"}},
      {"a link with two parents",
       robot_of(two_wheels() + joint({.name = "again", .child = "left_link", .type = "fixed"})),
       {"again", "is already the child of joint \"left\""}},
      {"a ring of links", robot_of(two_wheels() + kRing), {"cycle in the joint tree: a → b → a"}},
      // urdfdom would read its arguments from the stack.
      {"a format in a number",
       diffbot_with("<robot", "<mass value=\"3.45\"/>", "<mass value=\"%s%s%n\"/>"),
       {"diffbot.urdf", "<mass>", "percent"}},
      {"an empty name",
       diffbot_with("<robot", "<joint name=\"left_wheel_joint\"", "<joint name=\"\""),
       {"diffbot.urdf", "<joint>", "name is empty"}},
      {"losses beyond any joint", robot_of(two_wheels() + kLossy), {"<joint name=\"p\">: <dynamics> of 1e+300"}},
      {"an axis without a direction",
       diffbot_with(kFirstJoint, "<axis xyz=\"0 1 0\"/>", "<axis xyz=\"0 0 0\"/>"),
       {"diffbot.urdf", "left_wheel_joint", "axis"}},
      {"a negative size",
       diffbot_with(kLeftLink, kWheelShape + "<geometry><cylinder radius=\"0.1\"",
                    "<collision><geometry><cylinder radius=\"-0.1\""),
       {"diffbot.urdf", "left_wheel_link", "-0.1 m"}},
  };
  for (const Spoilt& spoilt : cases) {
    const std::string message = refusal(spoilt.description);
    for (const std::string& name : spoilt.names) EXPECT_THAT(message, HasSubstr(name)) << spoilt.what;
    EXPECT_THAT(message, Not(HasSubstr(".."))) << spoilt.what;
  }
}

TEST(RobotRefusals, AFileThatIsNotThere) {
  const std::string message = message_of<RobotError>([&] { load_description("/nowhere/robot.urdf"); });
  EXPECT_THAT(message, HasSubstr("/nowhere/robot.urdf"));
}

TEST(RobotRefusals, AMissingWheelJointAndNamesThoseThereAre) {
  DriveTrainParameters parameters = named();
  parameters.left_wheel_joints = {"wheel_l"};
  EXPECT_THAT(refusal(diffbot_urdf(), parameters),
              AllOf(names("wheel_l", "no such joint"), HasSubstr("left_wheel_joint, right_wheel_joint")));
}

TEST(RobotRefusals, OneJointForBothWheels) {
  DriveTrainParameters parameters = named();
  parameters.right_wheel_joints = {"left_wheel_joint"};
  EXPECT_THAT(refusal(diffbot_urdf(), parameters), names("left_wheel_joint", "named twice"));
}

TEST(RobotRefusals, LeftAndRightExchanged) {
  DriveTrainParameters parameters = named();
  std::swap(parameters.left_wheel_joints, parameters.right_wheel_joints);
  EXPECT_THAT(refusal(diffbot_urdf(), parameters), names("left_wheel_joint", "is not left of"));
}

TEST(RobotRefusals, AFixedWheelJoint) {
  const RobotDescription description = diffbot_with(kFirstJoint, "continuous", "fixed");
  EXPECT_THAT(refusal(description), names("left_wheel_joint", "fixed"));
  EXPECT_THAT(refusal(description, named()), names("left_wheel_joint", "fixed"));
}

TEST(RobotRefusals, ASlidingWheelJoint) {
  RobotDescription description = diffbot_with(kFirstJoint, "continuous", "prismatic");
  description.text =
      replaced(description.text, kFirstJoint, "effort=\"3.5\"", "lower=\"0\" upper=\"1\" effort=\"3.5\"");
  EXPECT_THAT(refusal(description), names("left_wheel_joint", "type=\"prismatic\""));
  EXPECT_THAT(refusal(description, named()), names("left_wheel_joint", "type=\"prismatic\""));
}

// tan 0.3° = 0.0052, tan 0.1° = 0.0017: either side of the 0.2° that are allowed.
TEST(RobotRefusals, AnAxisThatIsNotLateral) {
  EXPECT_THAT(refusal(diffbot_with(kFirstJoint, "<axis xyz=\"0 1 0\"/>", "<axis xyz=\"0.0052 1 0\"/>")),
              names("left_wheel_joint", "0.2°"));
  EXPECT_THAT(refusal(diffbot_with(kFirstJoint, "<axis xyz=\"0 1 0\"/>", "<axis xyz=\"0.0052 1 0\"/>"), named()),
              names("left_wheel_joint", "0.2°"));
  EXPECT_EQ(refusal(diffbot_with(kFirstJoint, "<axis xyz=\"0 1 0\"/>", "<axis xyz=\"0.0017 1 0\"/>")), "accepted");
}

TEST(RobotRefusals, AWheelWithoutAnyShape) {
  RobotDescription description = diffbot_urdf();
  for (const std::string kind : {"visual", "collision"}) {
    const std::size_t begin = description.text.find("<" + kind + ">", description.text.find(kLeftLink));
    const std::string end = "</" + kind + ">";
    description.text.erase(begin, description.text.find(end, begin) + end.size() - begin);
  }
  EXPECT_THAT(refusal(description), names("left_wheel_joint", "no <collision> shape"));
  EXPECT_THAT(refusal(description, named()), names("left_wheel_link", "no <collision> shape"));
}

TEST(RobotRefusals, AWheelShapeBesideItsAxle) {
  EXPECT_THAT(refusal(diffbot_with(kLeftLink, "<collision>\n      <origin rpy=\"1.5707963267948966 0 0\"/>",
                                   "<collision>\n      <origin xyz=\"0.01 0 0\" rpy=\"1.5707963267948966 0 0\"/>")),
              names("left_wheel_joint", "round about the axle"));
  EXPECT_THAT(refusal(diffbot_with(kLeftLink, "<collision>\n      <origin rpy=\"1.5707963267948966 0 0\"/>",
                                   "<collision>\n      <origin rpy=\"0 0 0\"/>")),
              names("left_wheel_joint", "Fix: Set rpy=\"1.5708 0 0\" in the <origin> of the cylinder"));
}

TEST(RobotRefusals, AMovingLinkOfZeroOrNegativeMass) {
  for (const std::string mass : {"0", "0.0", "-1", "-1e-9"}) {
    EXPECT_THAT(refusal(diffbot_with(kLeftLink, "<mass value=\"1.0\"/>", "<mass value=\"" + mass + "\"/>")),
                names("left_wheel_link", "mass"))
        << mass;
  }
}

TEST(RobotRefusals, AnImuOnAWheel) {
  DriveTrainParameters parameters;
  parameters.imu_link = "imu_link";
  const RobotDescription description =
      diffbot_with("<joint name=\"imu_joint\"", "<parent link=\"base_link\"/>", "<parent link=\"left_wheel_link\"/>");
  EXPECT_THAT(refusal(description, parameters), names("imu_link", "moves relative to base_link"));
  EXPECT_EQ(refusal(description), "accepted");
}

TEST(RobotRefusals, AnImuNowhere) {
  DriveTrainParameters parameters;
  parameters.imu_position = Vector3{0, std::numeric_limits<double>::quiet_NaN(), 0};
  EXPECT_THAT(refusal(diffbot_urdf(), parameters), names("robot.imu_position", "three finite numbers"));
  parameters.imu_position.reset();
  parameters.imu_orientation = Vector3{0, 0, std::numeric_limits<double>::infinity()};
  EXPECT_THAT(refusal(diffbot_urdf(), parameters), names("robot.imu_orientation", "three finite numbers"));
}

TEST(RobotRefusals, AFloatingJointOnARootThatIsNotEmptyOrCarriesMore) {
  const std::string joints = joint({.name = "free", .child = "base_link", .type = "floating", .parent = "world"});
  const std::string lamp =
      link("lamp", "") + joint({.name = "lamp_joint", .child = "lamp", .type = "fixed", .parent = "world"});
  const std::string box = "<geometry><box size=\"1 1 1\"/></geometry>";
  const auto refused = AllOf(
      HasSubstr("line 1: <joint name=\"free\">: a floating joint is supported only as the single joint of an empty "
                "root link"),
      HasSubstr("Set type to fixed"));
  EXPECT_EQ(refusal(robot_of(link("world", "") + joints + two_wheels())), "accepted");
  for (const std::string& world :
       {link("world", inertial("1")), link("world", "<visual>" + box + "</visual>"),
        link("world", "<collision>" + box + "</collision>"), link("world", "") + lamp, std::string()}) {
    EXPECT_THAT(refusal(robot_of(world + joints + two_wheels())), refused) << world;
  }
}

TEST(RobotRefusals, ATruncatedFileAtEveryByte) {
  const RobotDescription whole = diffbot_urdf();
  const std::size_t end = whole.text.rfind("</robot");
  for (std::size_t length = 0; length < end; length += 7) {
    EXPECT_THAT(refusal({whole.text.substr(0, length), whole.source}), HasSubstr("diffbot.urdf")) << length;
  }
}

TEST(RobotRefusals, AMillionElementsInOneAnother) {
  std::string deep = "<robot name=\"r\">";
  for (int i = 0; i < 1000000; ++i) deep += "<a>";
  EXPECT_THAT(refusal({deep, "diffbot.urdf"}), names("XML", "deep"));
}

TEST(RobotRefusals, AChainOfTooManyLinks) {
  std::string text = two_wheels(), parent = "base_link";
  for (int i = 0; i < 20000; ++i) {
    const std::string name = "link" + std::to_string(i);
    text +=
        link(name, "") + joint({.name = "to_" + name, .child = name, .type = "fixed", .axis = "", .parent = parent});
    parent = name;
  }
  EXPECT_THAT(refusal(robot_of(text)),
              HasSubstr("20003 links. Merge links that are fixed to each other; the limit is 2000"));
}

TEST(RobotRefusals, TooManyShapes) {
  std::string shapes;
  for (int i = 0; i < 60000; ++i) shapes += collision("<box size=\"0.1 0.1 0.1\"/>");
  EXPECT_THAT(refusal(robot_of(two_wheels() + link("heap", shapes))),
              HasSubstr("60003 shapes. Replace them with simpler shapes; the limit is 4000"));
}

TEST(RobotRefusals, NumbersBeyondAllBounds) {
  EXPECT_THAT(refusal(diffbot_with("<robot", "<mass value=\"3.45\"/>", "<mass value=\"1e308\"/>")), Not("accepted"));
  EXPECT_THAT(refusal(diffbot_with(kFirstJoint, "xyz=\"0 0.25 0\"", "xyz=\"0 1e200 0\"")), Not("accepted"));
}

TEST(RobotRefusals, MoreJointsThanAFrameHolds) {
  std::string text = two_wheels();
  for (int i = 0; i < 31; ++i) {
    const std::string name = "l" + std::to_string(i);
    text += link(name, inertial("1")) + joint({.name = "j" + name, .child = name});
  }
  EXPECT_THAT(refusal(robot_of(text)), AllOf(HasSubstr("<robot>"), HasSubstr("33 moving joints")));
}

class AnOverrideThatIsNotAboveZero : public testing::TestWithParam<double> {};

TEST_P(AnOverrideThatIsNotAboveZero, IsRefused) {
  DriveTrainParameters base;
  base.wheel_base = GetParam();
  EXPECT_THAT(refusal(diffbot_urdf(), base), names("robot.wheel_base", "above zero"));
  DriveTrainParameters radius;
  radius.wheel_radius = GetParam();
  EXPECT_THAT(refusal(diffbot_urdf(), radius), names("robot.wheel_radius", "above zero"));
}

INSTANTIATE_TEST_SUITE_P(RobotRefusals, AnOverrideThatIsNotAboveZero,
                         testing::Values(0.0, -0.5, std::numeric_limits<double>::quiet_NaN(),
                                         std::numeric_limits<double>::infinity()));

}  // namespace robot_control::tests
