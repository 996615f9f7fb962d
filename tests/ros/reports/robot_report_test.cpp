#include "ros/reports/robot_report.h"

#include <gtest/gtest.h>

#include "machine/wheeled/drive_train.h"

namespace robot_control::tests {

DriveTrain two_wheels() {
  DriveTrain robot;
  robot.name = "small";
  robot.source = "small.urdf";
  robot.joints.resize(2);
  robot.joints[0].name = "port";
  robot.joints[1].name = "starboard";
  robot.wheels = {WheelModel{.joint = 0, .radius = 0.033},
                  WheelModel{.joint = 1, .radius = 0.033, .side = Side::kRight}};
  robot.wheel_base = 0.16;
  robot.mass = 1;
  return robot;
}

TEST(RobotReport, SaysWhatWasUnderstood) {
  EXPECT_EQ(
      summary(two_wheels()),
      "robot 'small' of small.urdf: left wheels port, right wheels starboard, radius 0.033 m, wheel base 0.16 m, 1 kg");
  DriveTrain skid = two_wheels();
  skid.wheel_base_multiplier = 1.5;
  EXPECT_NE(summary(skid).find("wheel base 0.16 m (effective 0.24 m)"), std::string::npos);
}

TEST(RobotReport, WarnsOfWhatAUserShouldLookAt) {
  using Kind = RobotNote::Kind;
  for (const Kind kind : {Kind::kRepaired, Kind::kOverridden, Kind::kSuspicious}) {
    EXPECT_TRUE(needs_a_look({.kind = kind, .element = "", .text = ""}));
  }
  for (const Kind kind : {Kind::kAssumed, Kind::kIgnored}) {
    EXPECT_FALSE(needs_a_look({.kind = kind, .element = "", .text = ""}));
  }
  EXPECT_EQ(sentence({.kind = Kind::kAssumed, .element = "<joint>", .text = "5 N·m"}), "assumed: <joint>: 5 N·m");
}

}  // namespace robot_control::tests
