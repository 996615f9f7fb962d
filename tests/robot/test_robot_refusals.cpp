/// Every refusal names the file, the element and what to do.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "robot/robot_model.h"
#include "support/diffbot_urdf.h"

namespace robot_control {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const std::string kLeftJoint = "<joint name=\"left_wheel_joint\"";
const std::string kLeftLink = "<link name=\"left_wheel_link\">";

std::string refusal(const RobotDescription& description, const RobotParameters& parameters = {}) {
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  std::string message = "accepted";
  try {
    read_robot(description, parameters);
  } catch (const RobotError& error) {
    message = error.what();
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  return message;
}

auto names(const std::string& element, const std::string& what) {
  return AllOf(HasSubstr("diffbot.urdf"), HasSubstr(element), HasSubstr(what));
}

TEST(RobotRefusals, AFileThatIsNotThere) {
  try {
    load_description("/nowhere/robot.urdf");
    FAIL();
  } catch (const RobotError& error) {
    EXPECT_THAT(error.what(), HasSubstr("/nowhere/robot.urdf"));
  }
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
  EXPECT_THAT(refusal(diffbot_with(kLeftJoint, "<child link=\"left_wheel_link\"/>", "<child link=\"nowhere\"/>")),
              names("<robot>", "nowhere"));
}

TEST(RobotRefusals, AMissingWheelJointAndNamesThoseThereAre) {
  RobotParameters parameters;
  parameters.left_wheel_joint = "wheel_l";
  EXPECT_THAT(refusal(diffbot_urdf(), parameters),
              AllOf(names("wheel_l", "no such joint"), HasSubstr("left_wheel_joint, right_wheel_joint")));
}

TEST(RobotRefusals, ARobotWithoutWheels) {
  const std::string text =
      "<robot name=\"r\"><link name=\"a\"><inertial><mass value=\"1\"/><inertia ixx=\"1\" iyy=\"1\" izz=\"1\" "
      "ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link></robot>";
  EXPECT_THAT(refusal({text, "diffbot.urdf"}), names("left_wheel_joint", "moving joints: none"));
}

TEST(RobotRefusals, OneJointForBothWheels) {
  RobotParameters parameters;
  parameters.right_wheel_joint = "left_wheel_joint";
  EXPECT_THAT(refusal(diffbot_urdf(), parameters), names("left_wheel_joint", "right wheel as well"));
}

TEST(RobotRefusals, LeftAndRightExchanged) {
  RobotParameters parameters;
  std::swap(parameters.left_wheel_joint, parameters.right_wheel_joint);
  EXPECT_THAT(refusal(diffbot_urdf(), parameters), names("left_wheel_joint", "is not left of"));
}

TEST(RobotRefusals, AFixedWheelJoint) {
  EXPECT_THAT(refusal(diffbot_with(kLeftJoint, "continuous", "fixed")), names("left_wheel_joint", "fixed"));
}

TEST(RobotRefusals, ASlidingWheelJoint) {
  RobotDescription description = diffbot_with(kLeftJoint, "continuous", "prismatic");
  EXPECT_THAT(refusal(description), names("left_wheel_joint", "slides"));
}

// tan 0.3° = 0.0052, tan 0.1° = 0.0017: either side of the 0.2° that are allowed.
TEST(RobotRefusals, AnAxisThatIsNotLateral) {
  EXPECT_THAT(refusal(diffbot_with(kLeftJoint, "<axis xyz=\"0 1 0\"/>", "<axis xyz=\"0.0052 1 0\"/>")),
              names("left_wheel_joint", "0.2°"));
  EXPECT_EQ(refusal(diffbot_with(kLeftJoint, "<axis xyz=\"0 1 0\"/>", "<axis xyz=\"0.0017 1 0\"/>")), "accepted");
}

TEST(RobotRefusals, AWheelWithoutCollisionShape) {
  RobotDescription description = diffbot_with(kLeftLink, "<collision>", "<visual>");
  description.text = replaced(description.text, kLeftLink, "</collision>", "</visual>");
  EXPECT_THAT(refusal(description), names("left_wheel_link", "no collision cylinder or sphere"));
}

TEST(RobotRefusals, AWheelShapeBesideItsAxle) {
  EXPECT_THAT(refusal(diffbot_with(kLeftLink, "<collision>\n      <origin rpy=\"1.5707963267948966 0 0\"/>",
                                   "<collision>\n      <origin xyz=\"0.01 0 0\" rpy=\"1.5707963267948966 0 0\"/>")),
              names("left_wheel_link", "around the axle"));
  EXPECT_THAT(refusal(diffbot_with(kLeftLink, "<collision>\n      <origin rpy=\"1.5707963267948966 0 0\"/>",
                                   "<collision>\n      <origin rpy=\"0 0 0\"/>")),
              names("left_wheel_link", "around the axle"));
}

TEST(RobotRefusals, AWheelWithoutLimits) {
  EXPECT_THAT(refusal(diffbot_with(kLeftJoint, "<limit effort=\"3.5\" velocity=\"30\"/>", "")),
              names("left_wheel_joint", "limit"));
}

TEST(RobotRefusals, WheelsOnTwoAxles) {
  EXPECT_THAT(refusal(diffbot_with(kLeftJoint, "<origin xyz=\"0 0.25 0\"/>", "<origin xyz=\"0.1 0.25 0\"/>")),
              names("left_wheel_joint", "one axle"));
}

TEST(RobotRefusals, AMovingBodyWithoutMass) {
  EXPECT_THAT(refusal(diffbot_with(kLeftLink, "<mass value=\"1.0\"/>", "<mass value=\"0\"/>")),
              names("left_wheel_link", "no mass"));
}

TEST(RobotRefusals, ANegativeMass) {
  EXPECT_THAT(refusal(diffbot_with("<robot", "<mass value=\"3.45\"/>", "<mass value=\"-3.45\"/>")),
              names("battery_link", "mass"));
}

TEST(RobotRefusals, AnInertiaThatNoBodyHas) {
  EXPECT_THAT(refusal(diffbot_with(kLeftLink, "iyy=\"0.005\"", "iyy=\"0.006\"")), names("left_wheel_link", "inertia"));
}

TEST(RobotRefusals, AnImuOnAWheel) {
  EXPECT_THAT(refusal(diffbot_with("<joint name=\"imu_joint\"", "<parent link=\"base_link\"/>",
                                   "<parent link=\"left_wheel_link\"/>")),
              names("imu_link", "moves against base_link"));
}

TEST(RobotRefusals, AFloatingJointInTheTree) {
  EXPECT_THAT(refusal(diffbot_with("<joint name=\"imu_joint\"", "fixed", "floating")), names("imu_joint", "floating"));
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

class AnOverrideThatIsNoLength : public testing::TestWithParam<double> {};

TEST_P(AnOverrideThatIsNoLength, IsRefused) {
  RobotParameters base;
  base.wheel_base = GetParam();
  EXPECT_THAT(refusal(diffbot_urdf(), base), names("wheel_base", "length"));
  RobotParameters radius;
  radius.wheel_radius = GetParam();
  EXPECT_THAT(refusal(diffbot_urdf(), radius), names("wheel_radius", "length"));
}

INSTANTIATE_TEST_SUITE_P(RobotRefusals, AnOverrideThatIsNoLength,
                         testing::Values(0.0, -0.5, std::numeric_limits<double>::quiet_NaN(),
                                         std::numeric_limits<double>::infinity()));

}  // namespace
}  // namespace robot_control
