#include <algorithm>
#include <cmath>

#include "log/fields/trace_fields.h"
#include "log/rows/traces.h"
#include "signals/wheeled/drive_tuning.h"
#include "support/matchers.h"

namespace robot_control::tests {

using ::testing::IsSupersetOf;

std::vector<std::string> names_of(const std::vector<TraceColumn>& columns) {
  std::vector<std::string> names;
  for (const TraceColumn& column : columns) names.push_back(column.name);
  return names;
}

std::vector<std::string> words(const std::string& text) {
  std::istringstream from(text);
  return {std::istream_iterator<std::string>(from), {}};
}

struct Columns : ::testing::Test {
  Columns() {
    row.run = 2;
    row.cycle = 1234;
    row.time = row_time(1234, 0.001);
    row.driver = &driver;
    row.estimator = &estimator;
    row.controller = &controller;
    row.monitor = &monitor;
  }

  double value(const std::string& name) const {
    const auto column =
        std::find_if(columns.begin(), columns.end(), [&](const TraceColumn& c) { return c.name == name; });
    EXPECT_NE(column, columns.end()) << name;
    return column == columns.end() ? std::nan("") : column->value(row, column->element);
  }

  DriverTrace driver = driver_row(1, 1234);
  EstimatorTrace estimator = estimator_row(1, 1234);
  ControllerTrace controller = controller_row(1, 1234);
  MonitorTrace monitor = monitor_row(1, 1234);
  JoinedRow row;
  std::vector<TraceColumn> columns = log_columns(kJoints, kContactLinks, true);
};

TEST_F(Columns, HoldWhatReadersOfTheLogRelyOn) {
  EXPECT_THAT(
      names_of(columns),
      IsSupersetOf(words(
          "run cycle time truth_x truth_y truth_z truth_yaw truth_tilt truth_linear truth_lateral truth_vertical "
          "truth_angular estimate_x estimate_y estimate_yaw estimate_linear estimate_angular estimate_x_variance "
          "estimate_y_variance estimate_yaw_variance confidence_left_encoder confidence_right_encoder confidence_gyro "
          "confidence_accelerometer estimate_xy_covariance estimate_x_yaw_covariance estimate_y_yaw_covariance "
          "estimate_linear_variance estimate_angular_variance estimate_linear_angular_covariance estimate_lateral "
          "estimate_lateral_variance estimate_z estimate_roll estimate_pitch estimate_slip confidence_lateral_contact "
          "nis_gyro nis_vertical_contact rejected_left_encoder radius_ratio radius_ratio_deviation wheel_base_factor "
          "wheel_base_deviation gyro_bias_x gyro_bias_z_deviation wheel_odom_x wheel_odom_y wheel_odom_yaw "
          "estimate_flags requested_linear requested_angular limited_linear limited_angular command_reasons gyro_x "
          "gyro_y gyro_z accel_x accel_y accel_z permit_action supervisor_state permit_causes permit_warnings "
          "speed_limit evidence_cause evidence_value evidence_limit battery_voltage gate_verdict gate_reasons "
          "gate_command_cycle held missed driver_state faults stamp_ns driver_woke_ns sensors_published_ns "
          "estimator_woke_ns state_published_ns command_published_ns permit_published_ns overruns slipped_ns")));
  for (const std::string& joint : kJoints) {
    EXPECT_THAT(names_of(columns),
                IsSupersetOf({joint + "_position", joint + "_velocity", joint + "_effort", joint + "_effort_command",
                              joint + "_velocity_command", joint + "_velocity_measured"}));
  }
}

TEST_F(Columns, HaveNamesOfTheirOwn) {
  const std::vector<std::string> names = names_of(columns);
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
}

TEST_F(Columns, HaveAValueAndAMeaning) {
  for (const TraceColumn& column : columns) {
    EXPECT_NE(column.value, nullptr) << column.name;
    EXPECT_NE(column.meaning, "") << column.name;
  }
}

TEST_F(Columns, OmitTimesInLockstep) {
  std::vector<std::string> physical;
  for (const TraceColumn& column : columns) {
    if (!column.timing) physical.push_back(column.name);
  }
  EXPECT_EQ(names_of(log_columns(kJoints, kContactLinks, false)), physical);
  for (const std::string& name : physical) EXPECT_FALSE(name.ends_with("_ns")) << name;
}

TEST_F(Columns, AreEmptyWhereTheNodeHasNoFrame) {
  driver.sensors.valid = kValidBattery;
  monitor.permit.evidence[0].cause = kCauseTilt;
  for (const TraceColumn& column : columns) EXPECT_FALSE(std::isnan(column.value(row, column.element))) << column.name;
  row.estimator = nullptr;
  EXPECT_TRUE(std::isnan(value("estimate_x")));
  EXPECT_TRUE(std::isnan(value("estimate_flags"))) << "an integer, too";
  EXPECT_FALSE(std::isnan(value("truth_x")));
  EXPECT_FALSE(std::isnan(value("limited_linear")));
  EXPECT_FALSE(std::isnan(value("permit_action")));
}

TEST_F(Columns, NeedNoNodeForTheRow) {
  row.driver = nullptr;
  row.estimator = nullptr;
  row.controller = nullptr;
  row.monitor = nullptr;
  EXPECT_EQ(value("run"), 2);
  EXPECT_EQ(value("cycle"), 1234);
  EXPECT_EQ(value("time"), 1234 * 0.001);
}

TEST_F(Columns, KeepTheJointsApart) {
  driver.sensors.joints[0].effort = 1.5;
  driver.sensors.joints[1].effort = -2.5;
  controller.command.joints[1].velocity = 3;
  controller.command.wheeled.velocity[0] = 4;
  EXPECT_EQ(value("left_wheel_joint_effort"), 1.5);
  EXPECT_EQ(value("right_wheel_joint_effort"), -2.5);
  EXPECT_EQ(value("right_wheel_joint_velocity_command"), 3);
  EXPECT_EQ(value("left_wheel_joint_velocity_measured"), 4);
}

TEST_F(Columns, HoldTheTruthOfEachContact) {
  driver.truth.pose_world.position = {1, 2, 3};
  driver.truth.twist_base.linear = {4, 5, 6};
  driver.truth.normal_force = {7, 8};
  driver.truth.slip = {9, 10};
  EXPECT_EQ(value("truth_z"), 3);
  EXPECT_EQ(value("truth_lateral"), 5);
  EXPECT_EQ(value("truth_vertical"), 6);
  EXPECT_EQ(value("right_wheel_link_truth_normal_force"), 8);
  EXPECT_EQ(value("left_wheel_link_truth_slip"), 9);
}

TEST_F(Columns, ShowHowARobotOnLegsWalks) {
  controller.command.requested.twist.linear = {0.5, 0.2, 0};
  controller.command.twist_limited.linear = {0.4, 0.1, 0};
  controller.command.legged = {
      .phase = LegPhase::kWalking, .gait = 1, .gait_phase = 0.25, .slope = {0, -0.25}, .risers = 2, .reaches = 4};
  controller.command.contact_schedule = {0, 0.5, 0, 0.75};
  estimator.state.contacts[1].probability = 0.9;
  estimator.state.contacts[1].load = 60;
  EXPECT_EQ(value("requested_lateral"), 0.2);
  EXPECT_EQ(value("limited_lateral"), 0.1);
  EXPECT_EQ(value("legged_phase"), 6);
  EXPECT_EQ(value("legged_gait"), 1);
  EXPECT_EQ(value("legged_gait_phase"), 0.25);
  EXPECT_EQ(value("slope_left"), -0.25);
  EXPECT_EQ(value("legged_risers"), 2);
  EXPECT_EQ(value("legged_reaches"), 4);
  EXPECT_EQ(value("front_right_stance"), 0.5);
  EXPECT_EQ(value("rear_right_stance"), 0.75);
  EXPECT_EQ(value(kContactLinks[1] + "_estimate_contact_probability"), 0.9);
  EXPECT_EQ(value(kContactLinks[1] + "_estimate_contact_load"), 60);
}

TEST_F(Columns, TellWhatTheControllerWasSetTo) {
  controller.tuning = tuning_of(DriveTuning{
      .count = 3,
      .linear = {.speed = 1, .acceleration = 2, .deceleration = 3, .emergency_deceleration = 4, .jerk = 5},
      .angular = {.speed = 6, .acceleration = 7, .deceleration = 8, .emergency_deceleration = 9, .jerk = 10},
      .keep_curvature = 1,
      .cmd_vel_timeout = 11,
      .tracking_bandwidth = 12,
      .mass = 13,
      .yaw_inertia = 14});
  content_of<DriveTuning>(controller.tuning).wheels[1] = {
      .kp = 15, .ki = 16, .kd = 17, .model_inertia = 0, .inertia = 18, .damping = 19, .friction = 20};
  EXPECT_EQ(value("tuning"), 3);
  EXPECT_EQ(value("keep_curvature"), 1);
  double expected = 0;
  for (const std::string& name :
       words("max_linear_speed max_linear_acceleration max_linear_deceleration max_linear_emergency_deceleration "
             "max_linear_jerk max_angular_speed max_angular_acceleration max_angular_deceleration "
             "max_angular_emergency_deceleration max_angular_jerk cmd_vel_timeout tracking_bandwidth feed_forward_mass "
             "feed_forward_yaw_inertia right_wheel_joint_pid_kp right_wheel_joint_pid_ki right_wheel_joint_pid_kd "
             "right_wheel_joint_feed_forward_inertia right_wheel_joint_feed_forward_damping "
             "right_wheel_joint_feed_forward_friction")) {
    EXPECT_EQ(value(name), ++expected) << name;
  }
  EXPECT_EQ(value("left_wheel_joint_pid_kp"), 0);
}

// More joints than wheels may have loops: those of an arm have no such columns.
TEST_F(Columns, HaveGainsOfWheelsAlone) {
  std::vector<std::string> many;
  for (std::size_t i = 0; i < kMaxJoints; ++i) many.push_back("joint_" + std::to_string(i));
  const std::vector<std::string> names = names_of(log_columns(many, {}, false));
  EXPECT_EQ(std::ranges::count_if(names, [](const std::string& name) { return name.ends_with("_pid_kp"); }),
            static_cast<std::ptrdiff_t>(kMaxWheels));
}

// A turn by −2 rad about z: q = (0, 0, sin(−1), cos(−1)). Tolerance: a few roundings of numbers about 1.
TEST_F(Columns, TakeYawFromTheQuaternion) {
  estimator.state.base.pose_odom.orientation = {0, 0, std::sin(-1.0), std::cos(-1.0)};
  EXPECT_NEAR(value("estimate_yaw"), -2.0, 1e-15);
}

TEST_F(Columns, TakeVariancesFromTheDiagonal) {
  estimator.state.base.pose_covariance[0] = 1;
  estimator.state.base.pose_covariance[7] = 2;
  estimator.state.base.pose_covariance[35] = 3;
  EXPECT_EQ(value("estimate_x_variance"), 1);
  EXPECT_EQ(value("estimate_y_variance"), 2);
  EXPECT_EQ(value("estimate_yaw_variance"), 3);
}

// Row-major over x, y, z, roll, pitch, yaw.
TEST_F(Columns, TakeThePlanarBlocksOfTheCovariances) {
  for (std::size_t i = 0; i < 36; ++i) {
    estimator.state.base.pose_covariance[i] = static_cast<double>(i);
    estimator.state.base.twist_covariance[i] = 100 + static_cast<double>(i);
  }
  EXPECT_EQ(value("estimate_xy_covariance"), 1);
  EXPECT_EQ(value("estimate_x_yaw_covariance"), 5);
  EXPECT_EQ(value("estimate_y_yaw_covariance"), 11);
  EXPECT_EQ(value("estimate_linear_variance"), 100);
  EXPECT_EQ(value("estimate_lateral_variance"), 107);
  EXPECT_EQ(value("estimate_linear_angular_covariance"), 105);
  EXPECT_EQ(value("estimate_angular_variance"), 135);
}

// The attitude is yaw 0.7, then pitch 0.2, then roll −0.3 about the turned axes. The tolerance is a few roundings.
TEST_F(Columns, TakeRollAndPitchFromTheAttitude) {
  const double cr = std::cos(-0.15), sr = std::sin(-0.15), cp = std::cos(0.1), sp = std::sin(0.1);
  const double cy = std::cos(0.35), sy = std::sin(0.35);
  estimator.state.base.attitude = {sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy,
                                   cr * cp * sy - sr * sp * cy, cr * cp * cy + sr * sp * sy};
  EXPECT_NEAR(value("estimate_roll"), -0.3, 1e-15);
  EXPECT_NEAR(value("estimate_pitch"), 0.2, 1e-15);
  EXPECT_EQ(value("estimate_yaw"), 0);  // of the pose, which is planar
}

TEST_F(Columns, KeepTheSensorsApart) {
  for (std::size_t i = 0; i < 6; ++i) {
    estimator.state.wheeled.confidence[i] = 10 + static_cast<double>(i);
    estimator.state.wheeled.nis[i] = 20 + static_cast<double>(i);
    estimator.state.wheeled.rejected[i] = 30 + i;
  }
  EXPECT_EQ(value("confidence_left_encoder"), 10);
  EXPECT_EQ(value("confidence_accelerometer"), 13);
  EXPECT_EQ(value("nis_gyro"), 22);
  EXPECT_EQ(value("nis_lateral_contact"), 24);
  EXPECT_EQ(value("rejected_right_encoder"), 31);
  EXPECT_EQ(value("rejected_vertical_contact"), 35);
}

TEST_F(Columns, TellWhatTheEstimatorLearned) {
  estimator.state.wheeled.calibration = {
      .radius_ratio = 1, .wheel_base_factor = 2, .radius_ratio_deviation = 3, .wheel_base_deviation = 4};
  estimator.state.base.gyro_bias = {5, 6, 7};
  estimator.state.base.gyro_bias_deviation = {8, 9, 10};
  estimator.state.wheeled.odometry = {.x = 11, .y = 12, .yaw = 13, .linear = 14, .angular = 15};
  estimator.state.wheeled.slip = kSlipSpinning | kSlipBlocked;
  EXPECT_EQ(value("radius_ratio"), 1);
  EXPECT_EQ(value("wheel_base_factor"), 2);
  EXPECT_EQ(value("radius_ratio_deviation"), 3);
  EXPECT_EQ(value("wheel_base_deviation"), 4);
  EXPECT_EQ(value("gyro_bias_y"), 6);
  EXPECT_EQ(value("gyro_bias_z_deviation"), 10);
  EXPECT_EQ(value("wheel_odom_x"), 11);
  EXPECT_EQ(value("wheel_odom_yaw"), 13);
  EXPECT_EQ(value("wheel_odom_angular"), 15);
  EXPECT_EQ(value("estimate_slip"), 1 + 4);
}

TEST_F(Columns, LogTheGateOfTickKNotOfTheTickBefore) {
  driver.sensors.gate.verdict = GateVerdict::kPassed;
  driver.gate.verdict = GateVerdict::kHeld;
  EXPECT_EQ(value("gate_verdict"), static_cast<double>(GateVerdict::kHeld));
}

TEST_F(Columns, CarryBitsAsIntegers) {
  monitor.permit.causes = kCauseDriverLost | kCauseNotFinite;
  EXPECT_EQ(value("permit_causes"), (1 << 3) + (1 << 10));
}

TEST_F(Columns, ShowByWhatTheFirstCauseWasTold) {
  EXPECT_EQ(value("evidence_cause"), 0);
  EXPECT_TRUE(std::isnan(value("evidence_value")));
  EXPECT_TRUE(std::isnan(value("evidence_limit")));
  monitor.permit.evidence[0] = {.cause = kCauseBatteryEmpty, .value = 20.5, .limit = 21};
  monitor.permit.evidence[1] = {.cause = kCauseTilt, .value = 0.4, .limit = 0.35};
  EXPECT_EQ(value("evidence_cause"), 17179869184.0);  // 2^34
  EXPECT_EQ(value("evidence_value"), 20.5);
  EXPECT_EQ(value("evidence_limit"), 21);
}

TEST_F(Columns, ShowASpeedLimitWhereThereIsOne) {
  monitor.permit.speed_limit = kNoSpeedLimit;
  EXPECT_TRUE(std::isnan(value("speed_limit")));
  monitor.permit.speed_limit = 0.3;
  EXPECT_EQ(value("speed_limit"), 0.3);
  monitor.permit.warnings = kCauseBatteryLow;
  EXPECT_EQ(value("permit_warnings"), static_cast<double>(kCauseBatteryLow));
}

TEST_F(Columns, ShowTheBatteryWhereItIsMeasured) {
  driver.sensors.battery_voltage = 23.5;
  EXPECT_TRUE(std::isnan(value("battery_voltage")));
  driver.sensors.valid = kValidBattery;
  EXPECT_EQ(value("battery_voltage"), 23.5);
}

TEST_F(Columns, ShowTheInjectedFaultsAsOneOctalDigitPerComponent) {
  EXPECT_EQ(value("injected"), 0);
  InjectedFaults& injected = driver.sensors.injected;
  set_fault(injected, {.component = FaultComponent::kGyro, .kind = FaultKind::kStuck});
  EXPECT_EQ(value("injected"), 0200);
  set_fault(injected, {.component = FaultComponent::kMotor, .index = 1, .kind = FaultKind::kOff});
  EXPECT_EQ(value("injected"), 0210);
}

}  // namespace robot_control::tests
