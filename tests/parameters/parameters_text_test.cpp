#include "configuration/parameters.h"
#include "parameter_file.h"

namespace robot_control::tests {

TEST(ParametersText, IsReadBackAsTheSameValues) {
  const std::vector<Overlay> unusual{{"robot.rate", "333.3333333333333", "test"},
                                     {"robot.left_wheel_joints", "[\"a \\\"b\\\"\", \"c\\nd\"]", "test"},
                                     {"robot.right_wheel_joints", "[d, e]", "test"},
                                     {"robot.centre_of_gravity", "[0.1, -0.2, 0.30000000000000004]", "test"},
                                     {"robot.clock", "lockstep", "test"},
                                     {"diff_drive_controller.pid_kp", "1.25", "test"},
                                     {"safety_monitor.tilt", "{limit: 0.1, reaction: ramp}", "test"},
                                     {"telemetry.record", "request", "test"}};
  const std::string text = parameters_text(read_parameters(shipped_path(), unusual));
  ParameterFile file;
  file.write(text);
  const Parameters again = read_parameters(file.path());
  EXPECT_EQ(parameters_text(again), text);
  EXPECT_EQ(again.loop.rate, 333.3333333333333);
  EXPECT_EQ(again.robot.left_wheel_joints, (std::vector<std::string>{"a \"b\"", "c\nd"}));
  EXPECT_EQ((*again.robot.centre_of_gravity)[2], 0.30000000000000004);
  EXPECT_EQ(again.loop.clock, ClockMode::kLockstep);
  EXPECT_EQ(again.controller.pid_kp, 1.25);
  EXPECT_EQ(again.safety.tilt.limit, 0.1);
  EXPECT_EQ(again.telemetry.record, RecordMode::kRequest);
}

}  // namespace robot_control::tests
