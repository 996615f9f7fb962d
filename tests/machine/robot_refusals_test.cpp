/// Every refusal names the file, the element and the remedy.

#include <limits>

#include "machine/urdf_text.h"
#include "machine/wheeled/drive_train.h"
#include "support/matchers.h"
#include "support/message_of.h"
#include "support/quiet_refusal.h"
#include "support/robots/diffbot_urdf.h"

namespace robot_control {
namespace {

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

TEST(RobotRefusals, AFileThatIsNotThere) {
  const std::string message = message_of<RobotError>([&] { load_description("/nowhere/robot.urdf"); });
  EXPECT_THAT(message, HasSubstr("/nowhere/robot.urdf"));
}

TEST(RobotRefusals, MalformedXmlWithItsLine) {
  EXPECT_THAT(refusal(diffbot_with("<robot", "<link name=\"base_link\">", "<link name=\"base_link\"")),
              names("XML", "line "));
}

TEST(RobotRefusals, AnEmptyTextWithOneFullStopPerSentence) {
  EXPECT_THAT(refusal({"", "diffbot.urdf"}), AllOf(names("XML", "empty. "), Not(HasSubstr(".."))));
}

TEST(RobotRefusals, XmlThatIsNoRobot) {
  EXPECT_THAT(refusal({"<mujoco/>", "diffbot.urdf"}), names("<robot>", "no such element"));
}

TEST(RobotRefusals, WhatUrdfdomRefusesInItsOwnWords) {
  EXPECT_THAT(refusal(diffbot_with(kFirstJoint, "<child link=\"left_wheel_link\"/>", "<child link=\"nowhere\"/>")),
              names("<robot>", "nowhere"));
}

TEST(RobotRefusals, AMissingWheelJointAndNamesThoseThereAre) {
  DriveTrainParameters parameters = named();
  parameters.left_wheel_joints = {"wheel_l"};
  EXPECT_THAT(refusal(diffbot_urdf(), parameters),
              AllOf(names("wheel_l", "no such joint"), HasSubstr("left_wheel_joint, right_wheel_joint")));
}

TEST(RobotRefusals, ARobotWithoutWheels) {
  const std::string text =
      "<robot name=\"r\"><link name=\"a\"><inertial><mass value=\"1\"/><inertia ixx=\"1\" iyy=\"1\" izz=\"1\" "
      "ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link></robot>";
  EXPECT_THAT(refusal({text, "diffbot.urdf"}), names("<robot>", "no drive wheels found: no joint turns"));
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
  EXPECT_THAT(refusal(description), names("left_wheel_joint", "slides"));
  EXPECT_THAT(refusal(description, named()), names("left_wheel_joint", "slides"));
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
  EXPECT_THAT(refusal(description), names("left_wheel_joint", "no shape"));
  EXPECT_THAT(refusal(description, named()), names("left_wheel_link", "no shape"));
}

TEST(RobotRefusals, AWheelShapeBesideItsAxle) {
  EXPECT_THAT(refusal(diffbot_with(kLeftLink, "<collision>\n      <origin rpy=\"1.5707963267948966 0 0\"/>",
                                   "<collision>\n      <origin xyz=\"0.01 0 0\" rpy=\"1.5707963267948966 0 0\"/>")),
              names("left_wheel_joint", "round about the axle"));
  EXPECT_THAT(refusal(diffbot_with(kLeftLink, "<collision>\n      <origin rpy=\"1.5707963267948966 0 0\"/>",
                                   "<collision>\n      <origin rpy=\"0 0 0\"/>")),
              names("left_wheel_joint", "round about the axle"));
}

TEST(RobotRefusals, WheelsOnTwoAxles) {
  EXPECT_THAT(refusal(diffbot_with(kFirstJoint, "<origin xyz=\"0 0.25 0\"/>", "<origin xyz=\"0.1 0.25 0\"/>")),
              names("left_wheel_joint", "one axle"));
}

TEST(RobotRefusals, AMovingLinkOfZeroOrNegativeMass) {
  for (const std::string mass : {"0", "0.0", "-1", "-1e-9"}) {
    EXPECT_THAT(refusal(diffbot_with(kLeftLink, "<mass value=\"1.0\"/>", "<mass value=\"" + mass + "\"/>")),
                names("left_wheel_link", "mass"))
        << mass;
  }
}

TEST(RobotRefusals, ANegativeMass) {
  EXPECT_THAT(refusal(diffbot_with("<robot", "<mass value=\"3.45\"/>", "<mass value=\"-3.45\"/>")),
              names("battery_link", "mass"));
}

TEST(RobotRefusals, ABaseWithoutMass) {
  EXPECT_THAT(refusal(robot_of(link("base_link", "") + wheel("left", "0 0.25 0") + wheel("right", "0 -0.25 0"))),
              AllOf(HasSubstr("<link name=\"base_link\">"), HasSubstr("has a mass")));
}

TEST(RobotRefusals, AnImuOnAWheel) {
  DriveTrainParameters parameters;
  parameters.imu_link = "imu_link";
  const RobotDescription description =
      diffbot_with("<joint name=\"imu_joint\"", "<parent link=\"base_link\"/>", "<parent link=\"left_wheel_link\"/>");
  EXPECT_THAT(refusal(description, parameters), names("imu_link", "moves against base_link"));
  EXPECT_EQ(refusal(description), "accepted");
}

TEST(RobotRefusals, AnImuNowhere) {
  DriveTrainParameters parameters;
  parameters.imu_position = Vector3{0, std::numeric_limits<double>::quiet_NaN(), 0};
  EXPECT_THAT(refusal(diffbot_urdf(), parameters), names("robot/imu_position", "three finite numbers"));
  parameters.imu_position.reset();
  parameters.imu_orientation = Vector3{0, 0, std::numeric_limits<double>::infinity()};
  EXPECT_THAT(refusal(diffbot_urdf(), parameters), names("robot/imu_orientation", "three finite numbers"));
}

TEST(RobotRefusals, AFloatingJointInTheTree) {
  EXPECT_THAT(refusal(diffbot_with("<joint name=\"imu_joint\"", "fixed", "floating")), names("imu_joint", "floating"));
}

TEST(RobotRefusals, AFloatingJointOnARootThatIsNotEmptyOrCarriesMore) {
  const std::string joints = joint({.name = "free", .child = "base_link", .type = "floating", .parent = "world"});
  const std::string lamp =
      link("lamp", "") + joint({.name = "lamp_joint", .child = "lamp", .type = "fixed", .parent = "world"});
  const std::string box = "<geometry><box size=\"1 1 1\"/></geometry>";
  const auto refused =
      AllOf(HasSubstr("line 1: <joint name=\"free\">: a floating joint is supported only as the one joint of an empty "
                      "root link"),
            HasSubstr("Use fixed"));
  EXPECT_EQ(refusal(robot_of(link("world", "") + joints + two_wheels())), "accepted");
  for (const std::string& world :
       {link("world", inertial("1")), link("world", "<visual>" + box + "</visual>"),
        link("world", "<collision>" + box + "</collision>"), link("world", "") + lamp, std::string()}) {
    EXPECT_THAT(refusal(robot_of(world + joints + two_wheels())), refused) << world;
  }
}

TEST(RobotRefusals, AnUnknownJointTypeWithItsLine) {
  EXPECT_THAT(refusal(diffbot_with("<joint name=\"imu_joint\"", "fixed", "screwed")),
              AllOf(names("imu_joint", "type=\"screwed\" is unknown"), HasSubstr("line "), HasSubstr("prismatic")));
}

TEST(RobotRefusals, ATruncatedFileAtEveryByte) {
  const RobotDescription whole = diffbot_urdf();
  const std::size_t end = whole.text.rfind("</robot");
  for (std::size_t length = 0; length < end; length += 7) {
    EXPECT_THAT(refusal({whole.text.substr(0, length), whole.source}), HasSubstr("diffbot.urdf")) << length;
  }
}

TEST(RobotRefusals, TwoRootElements) {
  const RobotDescription one = robot_of(two_wheels());
  EXPECT_THAT(refusal({one.text + one.text, "r.urdf"}), HasSubstr("a second outermost element"));
}

TEST(RobotRefusals, TwoRootLinks) {
  EXPECT_THAT(refusal(robot_of(two_wheels() + link("lonely", ""))), HasSubstr("lonely"));
}

TEST(RobotRefusals, ALinkWithTwoParents) {
  EXPECT_THAT(refusal(robot_of(two_wheels() + joint({.name = "again", .child = "left_link", .type = "fixed"}))),
              AllOf(HasSubstr("again"), HasSubstr("already hangs on joint \"left\"")));
}

TEST(RobotRefusals, ARingOfLinks) {
  const std::string ring = link("a", "") + link("b", "") +
                           joint({.name = "ab", .child = "b", .type = "fixed", .parent = "a"}) +
                           joint({.name = "ba", .child = "a", .type = "fixed", .parent = "b"});
  EXPECT_THAT(refusal(robot_of(two_wheels() + ring)), HasSubstr("ring"));
}

// urdfdom would read its arguments from the stack.
TEST(RobotRefusals, AFormatInANumber) {
  EXPECT_THAT(refusal(diffbot_with("<robot", "<mass value=\"3.45\"/>", "<mass value=\"%s%s%n\"/>")),
              names("<mass>", "percent"));
}

TEST(RobotRefusals, AnEmptyName) {
  EXPECT_THAT(refusal(diffbot_with("<robot", "<joint name=\"left_wheel_joint\"", "<joint name=\"\"")),
              names("<joint>", "name is empty"));
}

TEST(RobotRefusals, LossesBeyondAnyJoint) {
  const std::string part =
      link("part", inertial("1")) + joint({.name = "p", .child = "part", .rest = "<dynamics friction=\"1e300\"/>"});
  EXPECT_THAT(refusal_of(robot_of(two_wheels() + part)), HasSubstr("<joint name=\"p\">: <dynamics> of 1e+300"));
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
  EXPECT_THAT(refusal_of(robot_of(text)), HasSubstr("20003 links. At most 2000 are read"));
}

TEST(RobotRefusals, TooManyShapes) {
  std::string shapes;
  for (int i = 0; i < 60000; ++i) shapes += collision("<box size=\"0.1 0.1 0.1\"/>");
  EXPECT_THAT(refusal_of(robot_of(two_wheels() + link("heap", shapes))),
              HasSubstr("60003 shapes. At most 4000 are read"));
}

TEST(RobotRefusals, AnAxisWithoutDirection) {
  EXPECT_THAT(refusal(diffbot_with(kFirstJoint, "<axis xyz=\"0 1 0\"/>", "<axis xyz=\"0 0 0\"/>")),
              names("left_wheel_joint", "axis"));
}

TEST(RobotRefusals, ANegativeSize) {
  EXPECT_THAT(refusal(diffbot_with(kLeftLink + "",
                                   "<collision>\n      <origin rpy=\"1.5707963267948966 0 0\"/>\n      "
                                   "<geometry><cylinder radius=\"0.1\"",
                                   "<collision><geometry><cylinder radius=\"-0.1\"")),
              names("left_wheel_link", "-0.1 m"));
}

TEST(RobotRefusals, NumbersBeyondAllBounds) {
  EXPECT_THAT(refusal(diffbot_with("<robot", "<mass value=\"3.45\"/>", "<mass value=\"1e308\"/>")), Not("accepted"));
  EXPECT_THAT(refusal(diffbot_with(kFirstJoint, "xyz=\"0 0.25 0\"", "xyz=\"0 1e200 0\"")), Not("accepted"));
}

TEST(RobotRefusals, MoreJointsThanAFrameHolds) {
  std::string extra;
  for (int i = 0; i < 31; ++i) {
    std::string name = "l";
    name += std::to_string(i);
    extra += "<link name=\"" + name +
             "\"><inertial><mass value=\"1\"/><inertia ixx=\"1\" iyy=\"1\" izz=\"1\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/>"
             "</inertial></link><joint name=\"j" +
             name + "\" type=\"continuous\"><parent link=\"base_link\"/><child link=\"" + name + "\"/></joint>";
  }
  EXPECT_THAT(refusal(diffbot_with("<robot", "</robot>", extra + "</robot>")), names("<robot>", "33 moving joints"));
}

class AnOverrideThatIsNotAboveZero : public testing::TestWithParam<double> {};

TEST_P(AnOverrideThatIsNotAboveZero, IsRefused) {
  DriveTrainParameters base;
  base.wheel_base = GetParam();
  EXPECT_THAT(refusal(diffbot_urdf(), base), names("robot/wheel_base", "above zero"));
  DriveTrainParameters radius;
  radius.wheel_radius = GetParam();
  EXPECT_THAT(refusal(diffbot_urdf(), radius), names("robot/wheel_radius", "above zero"));
}

INSTANTIATE_TEST_SUITE_P(RobotRefusals, AnOverrideThatIsNotAboveZero,
                         testing::Values(0.0, -0.5, std::numeric_limits<double>::quiet_NaN(),
                                         std::numeric_limits<double>::infinity()));

}  // namespace
}  // namespace robot_control
