/// Tests a file over the installed one, configurations of the peer, and YAML tags.

#include "control/wheeled/limits/drive_limits.h"
#include "parameter_file.h"
#include "parameters/suggestion.h"
#include "support/matchers.h"
#include "support/message_of.h"

namespace robot_control::tests {

struct Layers : ::testing::Test {
  Parameters read(const std::string& text, const std::vector<Overlay>& overlays = {}) {
    file.write(text);
    return read_parameters(file.path(), overlays, shipped_path());
  }

  std::string refusal(const std::string& text, const std::vector<Overlay>& overlays = {}) {
    return message_of<ParameterError>([&] { read(text, overlays); });
  }

  ParameterFile file;
};

TEST_F(Layers, AFileMayHoldOnlyTheKeysThatItChanges) {
  const Parameters parameters = read("robot:\n  rate: 500\n");
  const Parameters shipped = read_parameters(shipped_path());
  EXPECT_EQ(parameters.loop.rate, 500);
  EXPECT_EQ(parameters.controller.max_linear_speed, shipped.controller.max_linear_speed);
  EXPECT_EQ(parameters.plant.scene, shipped.plant.scene) << "relative to the installed file";
  EXPECT_EQ(parameters.urdf, shipped.urdf);
}

/// `rosparam set /diff_drive_controller/max_linear_speed/limit 0.3`.
TEST_F(Layers, AKeyBelowAValueIsUnknownWhereverTheValueStands) {
  for (const char* key : {"diff_drive_controller.max_linear_speed", "robot.rate", "safety_monitor.latch_file"}) {
    const std::string path = std::string(key) + ".limit";
    EXPECT_THAT(refusal("robot: {}\n", {{path, "0.3", "/server"}}), HasSubstr(path + " = 0.3: unknown key [/server]"));
  }
  EXPECT_THAT(refusal("robot:\n  rate: {limit: 0.3}\n"), Not(HasSubstr("unknown key"))) << "the map is the problem";
}

TEST_F(Layers, AMapMayHoldOnlyTheKeysThatItChanges) {
  const Parameters parameters = read("safety_monitor:\n  tilt: {limit: 0.3}\n");
  EXPECT_EQ(*parameters.safety.tilt.limit, 0.3);
  EXPECT_EQ(parameters.safety.tilt.persistence, read_parameters(shipped_path()).safety.tilt.persistence);
  EXPECT_THAT(refusal("safety_monitor:\n  tilt: 0.3\n"),
              AllOf(HasSubstr("1 problem\n"), HasSubstr("safety_monitor.tilt = 0.3: must be a map of limit")));
}

TEST_F(Layers, ItsRelativePathsCountFromItsOwnFolder) {
  EXPECT_EQ(read("robot: {urdf: mine.urdf}\n").urdf, (file.folder() / "mine.urdf").string());
}

TEST_F(Layers, AnOtherNameOfAKeyGoesBeforeTheInstalledOne) {
  ParameterFile base;
  base.append("");
  base.set("imu_link", "  imu_link: \"\"\n  wheel_base: 0.5");
  file.write("robot: {wheel_separation: 0.6}\n");
  EXPECT_EQ(read_parameters(file.path(), {}, base.path()).robot.wheel_base, 0.6);
  EXPECT_EQ(read_parameters(file.path(), {{"robot.wheel_base", "0.7", "server"}}, base.path()).robot.wheel_base, 0.7);
}

TEST_F(Layers, WhatIsWrongInItIsStillRefusedAndNothingElse) {
  EXPECT_THAT(refusal("robot:\n  rat: 500\n"), AllOf(HasSubstr("1 problem\n"), HasSubstr("did you mean rate?")));
  EXPECT_THAT(refusal("robott:\n  rate: 500\n"), AllOf(HasSubstr("1 problem\n"), HasSubstr("unknown block")));
  EXPECT_THAT(refusal("robot: {rate: 9}\n"), AllOf(HasSubstr("1 problem\n"), HasSubstr("params.yaml:1")));
  EXPECT_THAT(refusal("diff_drive_controller: {max_linear_emergency_deceleration: 0.5}\n"),
              AllOf(HasSubstr("1 problem\n"), HasSubstr("robot_params.yaml:")));
}

TEST_F(Layers, TheInstalledFileItselfIsNotLaidOverItself) {
  file.set("rate", "");
  const std::string link = file.folder() / "link.yaml";
  std::filesystem::create_symlink(file.path(), link);
  EXPECT_THROW(read_parameters(file.path(), {}, link), ParameterError) << "its rate is missing";
}

/// control.yaml of husky_control and jackal_control by the table of docs/interfaces.md, key by key.
TEST_F(Layers, HuskyAndJackalConvertedLiterallyAreAccepted) {
  const Parameters husky = read(R"(
robot: {wheel_separation_multiplier: 1.875}
diff_drive_controller:
  cmd_vel_timeout: 0.25
  max_linear_speed: 1.0
  max_linear_acceleration: 3.0
  max_angular_speed: 2.0
  max_angular_acceleration: 6.0
  command_rate: 50
state_estimator: {publish_tf: false, base_frame: base_link}
)");
  const SpeedLimits limits = speed_limits(husky.controller);
  EXPECT_EQ(limits.linear.emergency_deceleration, kHalfGrip);
  EXPECT_DOUBLE_EQ(limits.angular.emergency_deceleration, 6.0 * kHalfGrip / 3.0);
  EXPECT_EQ(refusal(R"(
robot: {wheel_separation_multiplier: 1.5}
diff_drive_controller:
  cmd_vel_timeout: 0.25
  max_linear_speed: 2.0
  max_linear_acceleration: 20.0
  max_angular_speed: 4.0
  max_angular_acceleration: 25.0
)"),
            "");
}

// For any given legal values the derived ones do not contradict them.
TEST_F(Layers, DerivedLimitsNeverContradictTheGivenOnes) {
  for (const double acceleration : {0.001, 0.5, 4.0, 6.0, 100.0}) {
    for (const double deceleration : {0.001, 0.5, 4.0, 6.0, 100.0}) {
      DriveControllerParameters given;
      given.max_linear_acceleration = given.max_angular_acceleration = acceleration;
      given.max_linear_deceleration = given.max_angular_deceleration = deceleration;
      const SpeedLimits limits = speed_limits(given);
      for (const MotionLimits& axis : {limits.linear, limits.angular}) {
        EXPECT_GE(axis.emergency_deceleration, axis.deceleration);
        EXPECT_LE(axis.emergency_deceleration, 2 * axis.deceleration);
        EXPECT_GE(axis.jerk, axis.emergency_deceleration) << "within a second";
      }
    }
  }
}

TEST_F(Layers, APastedFileOfThePeerIsKnownAsOneInOneMessage) {
  for (const char* text : {R"(husky_velocity_controller:
  type: "diff_drive_controller/DiffDriveController"
  left_wheel: ['front_left_wheel', 'rear_left_wheel']
  linear: {x: {has_velocity_limits: true, max_velocity: 1.0}}
)",
                           R"(jackal_joint_publisher: {type: "joint_state_controller/JointStateController"}
)",
                           R"(/**:
  ros__parameters:
    wheel_separation: 0.4
)",
                           R"(controller_manager:
  ros__parameters: {update_rate: 100}
diffbot_base_controller:
  ros__parameters: {left_wheel_names: ["left"]}
)",
                           R"(diff_drive_controller:
  type: diff_drive_controller/DiffDriveController
)",
                           R"(left_wheel: wheel_l
right_wheel: wheel_r
wheel_separation: 0.3
)",
                           R"(mobile_base: {controllers: {drive: {left_wheel_names: [a], right_wheel_names: [b]}}}
)"}) {
    const std::string said = refusal(text);
    EXPECT_THAT(said, AllOf(HasSubstr("1 problem\n"), HasSubstr("is a configuration of ros_controllers"),
                            HasSubstr("docs/interfaces.md"), HasSubstr("line 1")))
        << text;
  }
  EXPECT_EQ(refusal("robot: {left_wheel_joints: left_wheel_joint, right_wheel_joint: right_wheel_joint}\n"), "");
}

TEST_F(Layers, AKeyOfThePeerIsAnsweredByTheOneOfOurs) {
  const auto said = [&](const std::string& key) { return refusal("diff_drive_controller:\n  " + key + ": 1\n"); };
  EXPECT_THAT(said("wheel_radius_multiplier"), AllOf(HasSubstr("here robot.wheel_radius"),
                                                     HasSubstr("docs/interfaces.md"), Not(HasSubstr("wheel_base"))));
  EXPECT_THAT(said("left_wheel_radius_multiplier"), HasSubstr("robot.left_wheel_radius_multiplier"));
  EXPECT_THAT(said("odom_frame_id"), HasSubstr("here state_estimator.odom_frame;"));
  EXPECT_THAT(said("velocity_rolling_window_size"), HasSubstr("speed_bandwidth"));
  EXPECT_THAT(said("use_stamped_vel"), HasSubstr("needs no key here"));
  EXPECT_THAT(refusal("diff_drive_controller:\n  linear: {x: {max_velocity: 1}}\n"), HasSubstr("max_linear_speed"));
  Parameters parameters;
  EXPECT_THAT(suggest_key(schema(parameters), "diff_drive_controller.angular.z.max_jerk"),
              HasSubstr("here max_angular_jerk"));
}

TEST_F(Layers, ATagIsRefusedAndNeverIgnored) {
  for (const char* value : {"!degrees 0.5", "!radians 0.2", "!!float 0.2", "!!str 0.2", "!<tag:me,2024:x> 0.2"}) {
    EXPECT_THAT(
        refusal("mujoco_plant:\n  slope: " + std::string(value) + "\n"),
        AllOf(HasSubstr("is a YAML tag, which is not supported [" + file.path() + ":2]"), HasSubstr("1 problem\n")))
        << value;
  }
  EXPECT_THAT(refusal("robot: {imu_orientation: [0, 0, !degrees 90]}\n"), HasSubstr("!degrees: is a YAML tag"));
  EXPECT_THAT(refusal("robot: !mine {rate: 500}\n"), HasSubstr("!mine: is a YAML tag"));
  EXPECT_THAT(refusal("safety_monitor: {tilt: !degrees {limit: 0.3}}\n"), HasSubstr("!degrees: is a YAML tag"));
  EXPECT_THAT(refusal("robot: {!degrees rate: 500}\n"), HasSubstr("!degrees: is a YAML tag"));
  EXPECT_THAT(refusal("robot: {rate: 500}\n", {{"mujoco_plant.slope", "!degrees 10", "dict"}}),
              HasSubstr("!degrees: is a YAML tag"));
}

TEST_F(Layers, AFileThatIsNoRegularOneIsRefused) {
  for (const char* path : {"/dev/zero", "/dev/null", "/tmp"}) {
    EXPECT_THAT(message_of<ParameterError>([&] { read_parameters(path, {}, shipped_path()); }),
                AllOf(HasSubstr("1 problem\n"), HasSubstr("only a regular file is read")));
  }
}

TEST_F(Layers, NoMessageRepeatsALongOrUnprintableInput) {
  const std::string name(100'000, 'n');
  for (const std::string& text :
       {"robot: {" + name + ": 1}\n", name + ": {rate: 1}\n", "robot: {rate: \"" + name + "\"}\n",
        "robot: {bus: !" + name + " 1}\n", std::string("robot: {\"ra\\0te\\e[2J\": 1}\n"),
        "robot: {clock: [" + name + "," + name + "]}\n"}) {
    const std::string said = refusal(text);
    EXPECT_LT(said.size(), 1500u);
    EXPECT_EQ(said.find('\0'), std::string::npos);
    EXPECT_EQ(said.find('\x1b'), std::string::npos);
    EXPECT_NE(said, "");
  }
}

}  // namespace robot_control::tests
