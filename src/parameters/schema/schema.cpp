#include "parameters/schema/schema.h"

#include <algorithm>
#include <array>

#include "parameters/calibration_bounds.h"
#include "parameters/problem_list.h"

namespace robot_control {
namespace {

template <auto Group, auto Member>
Field in(Parameters& parameters) {
  return &(parameters.*Group.*Member);
}
template <auto Member>
Field in(Parameters& parameters) {
  return &(parameters.*Member);
}

using P = Parameters;
using Safety = SafetyParameters;

template <auto Condition, auto Member>
Field in_condition(Parameters& parameters) {
  return &(parameters.safety.*Condition.*Member);
}

template <auto Member>
Field in_feed_forward(Parameters& parameters) {
  return &(parameters.controller.feed_forward.*Member);
}

template <std::size_t... Sizes>
constexpr auto rows(const std::array<Key, Sizes>&... parts) {
  std::array<Key, (Sizes + ...)> all;
  auto next = all.begin();
  ((next = std::copy(parts.begin(), parts.end(), next)), ...);
  return all;
}

// Keys of a condition that is true or false, such as lost or stuck.
template <auto Condition>
constexpr std::array<Key, 2> condition_without_limit(std::string_view group) {
  using C = robot_control::Condition;
  // The persistence is at most a minute; a longer one would not stop the robot in time.
  return {{{"persistence", in_condition<Condition, &C::persistence>, "s", 0, 60, 0, {}, group},
           {"reaction", in_condition<Condition, &C::reaction>, {}, 0, 0, 0, {}, group}}};
}

template <auto Condition>
constexpr std::array<Key, 3> condition(std::string_view group, std::string_view unit, double min, double max) {
  using C = robot_control::Condition;
  constexpr unsigned traits = (SafetyParameters{}.*Condition).limit ? 0U : unsigned{kOptional};
  return rows(std::to_array<Key>({{"limit", in_condition<Condition, &C::limit>, unit, min, max, traits, {}, group}}),
              condition_without_limit<Condition>(group));
}

// The bound of seed and cycles: a YAML integer, a Python int and a ROS parameter all represent every value below it.
constexpr double kAnyCount = 9007199254740992.0;  // 2^53

using Robot = RobotParameters;
constexpr auto kRobot = std::to_array<Key>({
    {"urdf", in<&P::urdf>, {}, 0, 0, kPath},
    {"left_wheel_joints", in<&P::robot, &Robot::left_wheel_joints>, {}, 0, 0, kOptional},
    {"left_wheel_joint", in<&P::robot, &Robot::left_wheel_joints>, {}, 0, 0, kOptional, "left_wheel_joints"},
    {"right_wheel_joints", in<&P::robot, &Robot::right_wheel_joints>, {}, 0, 0, kOptional},
    {"right_wheel_joint", in<&P::robot, &Robot::right_wheel_joints>, {}, 0, 0, kOptional, "right_wheel_joints"},
    {"wheel_base", in<&P::robot, &Robot::wheel_base>, "m", 0.01, 10, kOptional},
    {"wheel_separation", in<&P::robot, &Robot::wheel_base>, "m", 0.01, 10, kOptional, "wheel_base"},
    {"wheel_base_multiplier", in<&P::robot, &Robot::wheel_base_multiplier>, {}, 0.2, 20, kOptional},
    {"wheel_separation_multiplier",
     in<&P::robot, &Robot::wheel_base_multiplier>,
     {},
     0.2,
     20,
     kOptional,
     "wheel_base_multiplier"},
    {"wheel_radius", in<&P::robot, &Robot::wheel_radius>, "m", 0.005, 2, kOptional},
    {"left_wheel_radius_multiplier", in<&P::robot, &Robot::left_wheel_radius_multiplier>, {}, 0.5, 2, kOptional},
    {"right_wheel_radius_multiplier", in<&P::robot, &Robot::right_wheel_radius_multiplier>, {}, 0.5, 2, kOptional},
    {"wheel_effort_limit", in<&P::robot, &Robot::wheel_effort_limit>, "N·m", 0.001, 10000, kOptional},
    {"wheel_velocity_limit", in<&P::robot, &Robot::wheel_velocity_limit>, "rad/s", 0.01, 1000, kOptional},
    {"wheel_effort_rate", in<&P::robot, &Robot::wheel_effort_rate>, "N·m/s", 0.01, 1.0e9, kOptional},
    {"mass", in<&P::robot, &Robot::mass>, "kg", 0.01, 100000, kOptional},
    {"centre_of_gravity", in<&P::robot, &Robot::centre_of_gravity>, "m", -10, 10, kOptional},
    {"imu_link", in<&P::robot, &Robot::imu_link>, {}, 0, 0, kMayBeEmpty},
    {"imu_position", in<&P::robot, &Robot::imu_position>, "m", -10, 10, kOptional},
    {"imu_orientation", in<&P::robot, &Robot::imu_orientation>, "rad", -6.3, 6.3,
     kOptional},  // one full turn in each direction
    {"fail_action", in<&P::loop, &LoopParameters::fail_action>},
    {"rate", in<&P::loop, &LoopParameters::rate>, "Hz", 100, 2000},
    {"clock", in<&P::loop, &LoopParameters::clock>},
    {"realtime", in<&P::loop, &LoopParameters::realtime>},
    {"core", in<&P::loop, &LoopParameters::core>, {}, -1, 1023},
    {"bus", in<&P::loop, &LoopParameters::bus>, {}, 0, 0, kMayBeEmpty},
    {"command_script", in<&P::loop, &LoopParameters::command_script>, {}, 0, 0, kPath | kMayBeEmpty},
    {"wait_for_nodes", in<&P::loop, &LoopParameters::wait_for_nodes>},
    {"wait_for_telemetry", in<&P::loop, &LoopParameters::wait_for_telemetry>},
});

using Plant = MujocoPlantParameters;
constexpr auto kMujocoPlant = std::to_array<Key>({
    {"scene", in<&P::plant, &Plant::scene>, {}, 0, 0, kPath},
    {"seed", in<&P::plant, &Plant::seed>, {}, 0, kAnyCount},
    {"cycles", in<&P::plant, &Plant::cycles>, "cycles", 0, kAnyCount, kZeroIsOff},
    {"tyre", in<&P::plant, &Plant::tyre>},
    {"ground_friction", in<&P::plant, &Plant::ground_friction>, {}, 0, 10, kOptional},
    {"slope", in<&P::plant, &Plant::slope>, "rad", -1, 1},
    {"brake_effort", in<&P::plant, &Plant::brake_effort>, "N·m", 0.001, 10000, kOptional},
    {"brake_damping", in<&P::plant, &Plant::brake_damping>, "N·m·s/rad", 0, 10000, kOptional},
    {"brake_stiffness", in<&P::plant, &Plant::brake_stiffness>, "N·m/rad", 0, 1.0e6, kOptional},
    {"brake_hold_speed", in<&P::plant, &Plant::brake_hold_speed>, "rad/s", 0, 10, kOptional},
    {"left_radius_error", in<&P::plant, &Plant::left_radius_error>, {}, -0.5, 0.5},
    {"right_radius_error", in<&P::plant, &Plant::right_radius_error>, {}, -0.5, 0.5},
    {"wheel_base_error", in<&P::plant, &Plant::wheel_base_error>, {}, -0.5, 0.5},
    {"wheel_friction_error", in<&P::plant, &Plant::wheel_friction_error>, {}, -1, 10},
    {"payload", in<&P::plant, &Plant::payload>, "kg", 0, 10000},
    {"payload_x", in<&P::plant, &Plant::payload_x>, "m", -10, 10},
    {"payload_y", in<&P::plant, &Plant::payload_y>, "m", -10, 10},
    {"payload_z", in<&P::plant, &Plant::payload_z>, "m", -10, 10},
    {"gear_ratio", in<&P::plant, &Plant::gear_ratio>, {}, 0.001, 10000},
    {"rotor_inertia", in<&P::plant, &Plant::rotor_inertia>, "kg·m²", 0, 100},
    {"no_load_speed", in<&P::plant, &Plant::no_load_speed>, "rad/s", 0, 100000, kZeroIsOff},
    {"motor_friction", in<&P::plant, &Plant::motor_friction>, "N·m", 0, 1000},
    {"motor_damping", in<&P::plant, &Plant::motor_damping>, "N·m·s/rad", 0, 1000},
    {"actuator_delay", in<&P::plant, &Plant::actuator_delay>, "cycles", 0, 100},
    {"sensor_errors", in<&P::plant, &Plant::sensor_errors>},
    {"roughness", in<&P::plant, &Plant::roughness>, {}, 0, 100},
    {"accelerometer_vibration", in<&P::plant, &Plant::accelerometer_vibration>, "m/s²/√Hz", 0, 10},
    {"gyro_vibration", in<&P::plant, &Plant::gyro_vibration>, "rad/s/√Hz", 0, 1},
    {"accelerometer_slow_error", in<&P::plant, &Plant::accelerometer_slow_error>, "m/s²", 0, 10},
    {"imu_delay", in<&P::plant, &Plant::imu_delay>, "s", 0, 0.5},
    {"imu_jitter", in<&P::plant, &Plant::imu_jitter>, "s", 0, 0.1},
    {"encoder_jitter", in<&P::plant, &Plant::encoder_jitter>, "s", 0, 0.1},
    {"wheel_slip_noise", in<&P::plant, &Plant::wheel_slip_noise>, "m/√m", 0, 0.1},
    {"centre_of_gravity_error", in<&P::plant, &Plant::centre_of_gravity_error>, {}, -0.2, 0.2},
    {"encoder_resolution", in<&P::plant, &Plant::encoder_resolution>, "counts", 0, 1.0e9, kZeroIsOff},
    {"gyro_noise", in<&P::plant, &Plant::gyro_noise>, "rad/s/√Hz", 0, 1},
    {"gyro_bias", in<&P::plant, &Plant::gyro_bias>, "rad/s", 0, 10},
    {"gyro_bias_walk", in<&P::plant, &Plant::gyro_bias_walk>, "rad/s/√s", 0, 1},
    {"gyro_scale_error", in<&P::plant, &Plant::gyro_scale_error>, {}, -0.5, 0.5},
    {"accelerometer_noise", in<&P::plant, &Plant::accelerometer_noise>, "m/s²/√Hz", 0, 10},
    {"accelerometer_bias", in<&P::plant, &Plant::accelerometer_bias>, "m/s²", 0, 10},
    {"accelerometer_bias_walk", in<&P::plant, &Plant::accelerometer_bias_walk>, "m/s²/√s", 0, 10},
    {"sensor_delay", in<&P::plant, &Plant::sensor_delay>, "cycles", 0, 100},
    {"contact_sensors", in<&P::plant, &Plant::contact_sensors>},
    // At the idle current at most half a volt is lost (battery.h), so the voltage stays positive.
    {"battery_voltage", in<&P::plant, &Plant::battery_voltage>, "V", 1, 1000, kZeroIsOff},
    {"battery_resistance", in<&P::plant, &Plant::battery_resistance>, "Ω", 0, 1},
    {"push_x", in<&P::plant, &Plant::push_x>, "N", -100000, 100000},
    {"push_y", in<&P::plant, &Plant::push_y>, "N", -100000, 100000},
    {"push_z", in<&P::plant, &Plant::push_z>, "N", -100000, 100000},
    {"push_start", in<&P::plant, &Plant::push_start>, "s", 0, 1.0e6},
    {"push_duration", in<&P::plant, &Plant::push_duration>, "s", 0, 1.0e6, kZeroIsOff},
    {"imu_rate", in<&P::report, &ReportParameters::imu_rate>, "Hz", 0.1, 2000, kPublishRate},
    {"truth_rate", in<&P::report, &ReportParameters::truth_rate>, "Hz", 0.1, 2000, kPublishRate},
});

template <auto Member>
Field in_wheels(Parameters& parameters) {
  return &(parameters.estimator.calibration.*Member);
}

using Wheels = WheelCalibration;
constexpr auto kStateEstimator = std::to_array<Key>({
    {"wheel_slip_noise", in<&P::estimator, &EstimatorParameters::wheel_slip_noise>, "m/√m", 1.0e-6, 1},
    {"tyre_creep", in<&P::estimator, &EstimatorParameters::tyre_creep>, "s²/m", 0, 0.05},
    {"gyro_noise", in<&P::estimator, &EstimatorParameters::gyro_noise>, "rad/s/√Hz", 1.0e-9, 1},
    {"standstill_speed", in<&P::estimator, &EstimatorParameters::standstill_speed>, "rad/s", 1.0e-6, 1},
    {"standstill_time", in<&P::estimator, &EstimatorParameters::standstill_time>, "s", 0.01, 60},
    {"standstill_acceleration", in<&P::no_effect>, "m/s²", 0.001, 10, kOptional | kNoEffect},
    {"encoder_noise", in<&P::estimator, &EstimatorParameters::encoder_noise>, "rad", 1.0e-6, 1},
    {"wheel_radius_deviation", in<&P::estimator, &EstimatorParameters::wheel_radius_deviation>, {}, 0, 0.1},
    {"gyro_scale_deviation", in<&P::estimator, &EstimatorParameters::gyro_scale_deviation>, {}, 0, 0.1},
    {"gyro_bias_initial", in<&P::estimator, &EstimatorParameters::gyro_bias_initial>, "rad/s", 1.0e-6, 10},
    {"gyro_bias_walk", in<&P::estimator, &EstimatorParameters::gyro_bias_walk>, "rad/s/√s", 1.0e-9, 1},
    {"accelerometer_noise", in<&P::estimator, &EstimatorParameters::accelerometer_noise>, "m/s²/√Hz", 1.0e-9, 10},
    {"accelerometer_bias_initial", in<&P::estimator, &EstimatorParameters::accelerometer_bias_initial>, "m/s²", 1.0e-6,
     10},
    {"accelerometer_bias_walk", in<&P::estimator, &EstimatorParameters::accelerometer_bias_walk>, "m/s²/√s", 1.0e-9,
     10},
    {"slip_detection", in<&P::estimator, &EstimatorParameters::slip_detection>},
    {"self_calibration", in<&P::estimator, &EstimatorParameters::self_calibration>},
    {"planar", in<&P::estimator, &EstimatorParameters::planar>},
    {"radius_ratio", in_wheels<&Wheels::radius_ratio>, {}, kRadiusRatioMin, kRadiusRatioMax},
    {"radius_ratio_deviation", in_wheels<&Wheels::radius_ratio_deviation>, {}, 0, 0.05},
    {"wheel_base_factor", in_wheels<&Wheels::wheel_base_factor>, {}, kWheelBaseFactorMin, kWheelBaseFactorMax},
    {"wheel_base_deviation", in_wheels<&Wheels::wheel_base_deviation>, {}, 0, 0.3},
    {"gyro_bias", in<&P::estimator, &EstimatorParameters::gyro_bias>, "rad/s", -kGyroBiasMax, kGyroBiasMax},
    {"calibration_file", in<&P::calibration_file>, {}, 0, 0, kPath | kMayBeEmpty},
    {"speed_bandwidth", in<&P::estimator, &EstimatorParameters::speed_bandwidth>, "Hz", 0.1, 500},
    {"rate_bandwidth", in<&P::estimator, &EstimatorParameters::rate_bandwidth>, "Hz", 0.1, 500},
    {"joint_states_rate", in<&P::report, &ReportParameters::joint_states_rate>, "Hz", 0.1, 2000, kPublishRate},
    {"odom_rate", in<&P::report, &ReportParameters::odom_rate>, "Hz", 0.1, 2000, kPublishRate},
    {"imu_rate", in<&P::report, &ReportParameters::imu_data_rate>, "Hz", 0.1, 2000, kPublishRate},
    {"publish_tf", in<&P::report, &ReportParameters::publish_tf>},
    {"odom_frame", in<&P::report, &ReportParameters::odom_frame>},
    {"base_frame", in<&P::report, &ReportParameters::base_frame>, {}, 0, 0, kMayBeEmpty},
    {"pose_covariance_diagonal", in<&P::report, &ReportParameters::pose_covariance_diagonal>, {}, 0, 1e9, kOptional},
    {"twist_covariance_diagonal", in<&P::report, &ReportParameters::twist_covariance_diagonal>, {}, 0, 1e9, kOptional},
});

using Drive = DriveControllerParameters;
using Forward = FeedForwardParameters;
constexpr unsigned kDerived = kOptional | kLive;
constexpr auto kDiffDriveController = std::to_array<Key>({
    {"max_linear_speed", in<&P::controller, &Drive::max_linear_speed>, "m/s", 0.001, 50, kLive},
    {"max_angular_speed", in<&P::controller, &Drive::max_angular_speed>, "rad/s", 0.001, 50, kLive},
    {"max_linear_acceleration", in<&P::controller, &Drive::max_linear_acceleration>, "m/s²", 0.001, 100, kLive},
    {"max_angular_acceleration", in<&P::controller, &Drive::max_angular_acceleration>, "rad/s²", 0.001, 1000, kLive},
    {"max_linear_deceleration", in<&P::controller, &Drive::max_linear_deceleration>, "m/s²", 0.001, 100, kDerived},
    {"max_angular_deceleration", in<&P::controller, &Drive::max_angular_deceleration>, "rad/s²", 0.001, 1000, kDerived},
    {"min_linear_speed", in<&P::controller, &Drive::min_linear_speed>, "m/s", -50, 0, kDerived},
    {"max_linear_acceleration_reverse", in<&P::controller, &Drive::max_linear_acceleration_reverse>, "m/s²", 0.001, 100,
     kDerived},
    {"max_linear_deceleration_reverse", in<&P::controller, &Drive::max_linear_deceleration_reverse>, "m/s²", 0.001, 100,
     kDerived},
    {"max_linear_emergency_deceleration", in<&P::controller, &Drive::max_linear_emergency_deceleration>, "m/s²", 0.001,
     100, kDerived},
    {"max_angular_emergency_deceleration", in<&P::controller, &Drive::max_angular_emergency_deceleration>, "rad/s²",
     0.001, 1000, kDerived},
    {"max_linear_jerk", in<&P::controller, &Drive::max_linear_jerk>, "m/s³", 0.001, 1.0e6, kZeroIsOff | kDerived},
    {"max_angular_jerk", in<&P::controller, &Drive::max_angular_jerk>, "rad/s³", 0.001, 1.0e6, kZeroIsOff | kDerived},
    {"keep_curvature", in<&P::controller, &Drive::keep_curvature>, {}, 0, 0, kLive},
    {"cmd_vel_timeout", in<&P::controller, &Drive::cmd_vel_timeout>, "s", 0, 60, kTimeout | kZeroIsOff | kLive},
    {"one_sender", in<&P::controller, &Drive::one_sender>},
    {"command_sources", in<&P::command_sources>, {}, 0, 0, kPath | kMayBeEmpty | kOptional},
    {"pid_kp", in<&P::controller, &Drive::pid_kp>, "N·m·s/rad", 0, 10000, kDerived},
    {"pid_ki", in<&P::controller, &Drive::pid_ki>, "N·m/rad", 0, 1.0e6, kDerived},
    {"pid_kd", in<&P::controller, &Drive::pid_kd>, "N·m·s²/rad", 0, 1000, kLive},
    {"tracking_bandwidth", in<&P::controller, &Drive::tracking_bandwidth>, "Hz", 0.1, 500, kDerived},
    {"mass", in_feed_forward<&Forward::mass>, "kg", 0.01, 100000, kDerived, {}, "feed_forward"},
    {"yaw_inertia", in_feed_forward<&Forward::yaw_inertia>, "kg·m²", 1.0e-6, 1.0e6, kDerived, {}, "feed_forward"},
    {"wheel_inertia", in_feed_forward<&Forward::wheel_inertia>, "kg·m²", 1.0e-9, 1000, kDerived, {}, "feed_forward"},
    {"wheel_damping", in_feed_forward<&Forward::wheel_damping>, "N·m·s/rad", 0, 1000, kDerived, {}, "feed_forward"},
    {"wheel_friction", in_feed_forward<&Forward::wheel_friction>, "N·m", 0, 10000, kDerived, {}, "feed_forward"},
    {"command_rate", in<&P::report, &ReportParameters::command_rate>, "Hz", 0.1, 2000, kPublishRate},
});

constexpr auto kSafetyLimits = std::to_array<Key>({
    // The limit is above the four cycles for which the gate uses a command: a held command does not mean a lost node.
    {"loss_cycles", in<&P::safety, &Safety::loss_cycles>, "cycles", 5, 10000},
    {"heartbeat_timeout", in<&P::safety, &Safety::heartbeat_timeout>, "s", 0, 60, kTimeout | kZeroIsOff},
    {"ramp_time", in<&P::safety, &Safety::ramp_time>, "s", 0.01, 60},
    {"standstill_speed", in<&P::safety, &Safety::standstill_speed>, "rad/s", 1.0e-6,
     0.5},  // a reset must not release a moving robot
    {"slow_speed", in<&P::safety, &Safety::slow_speed>, "m/s", 0, 50},
    {"clearance", in<&P::safety, &Safety::clearance>, "m", 0, 10000, kZeroIsOff},
    {"stop_delay", in<&P::safety, &Safety::stop_delay>, "s", 0, 10},
    {"stop_deceleration", in<&P::safety, &Safety::stop_deceleration>, "m/s²", 0.001, 100},
    {"latch_file", in<&P::latch_file>, {}, 0, 0, kPath | kMayBeEmpty | kOptional},
});

// clang-format off
constexpr auto kSafetyMonitor = rows(kSafetyLimits
#define CAUSE(...)
#define CONDITION(id, name, sentence, remedy, actor, unit, min, max, ...) \
    , condition<&Safety::name>(#name, unit, min, max)
#define CONDITION_WITHOUT_LIMIT(id, name, ...) , condition_without_limit<&Safety::name>(#name)
#include "signals/stop_causes.def"
    );
// clang-format on

constexpr auto kTelemetry = std::to_array<Key>({
    {"directory", in<&P::telemetry, &TelemetryParameters::directory>, {}, 0, 0, kMayBeEmpty},
    {"record", in<&P::telemetry, &TelemetryParameters::record>},
    {"split_size", in<&P::telemetry, &TelemetryParameters::split_size>, "GB", 0.001, 1.0e6, kZeroIsOff},
    {"split_time", in<&P::telemetry, &TelemetryParameters::split_time>, "s", 1, 1.0e9, kZeroIsOff},
    {"quota", in<&P::telemetry, &TelemetryParameters::quota>, "GB", 0.001, 1.0e6, kZeroIsOff},
    {"black_box", in<&P::telemetry, &TelemetryParameters::black_box>, "GB", 0.001, 100, kZeroIsOff},
    {"incidents", in<&P::telemetry, &TelemetryParameters::incidents>, {}, 1, 10000, kZeroIsOff},
});

constexpr auto kBlocks = std::to_array<Block>({
    {"robot", kRobot},
    {"mujoco_plant", kMujocoPlant},
    {"state_estimator", kStateEstimator},
    {"diff_drive_controller", kDiffDriveController},
    {"safety_monitor", kSafetyMonitor},
    {"telemetry", kTelemetry},
});

std::string range_of(const Key& key, std::string_view noun) {
  std::string rule = (key.traits & kZeroIsOff) != 0 && key.min > 0 ? "0 (off) or " : "";
  rule += std::string(noun) + " of " + shortest(key.min) + " … " + shortest(key.max);
  if (!key.unit.empty()) rule.append(" ").append(key.unit);
  if ((key.traits & kZeroIsOff) != 0 && key.min <= 0) rule += " (0 = off)";
  return rule;
}

template <class... Case>
struct Cases : Case... {
  using Case::operator()...;
};
template <class... Case>
Cases(Case...) -> Cases<Case...>;

}  // namespace

std::span<const Block> schema() {
  return kBlocks;
}

std::string path_of(const Block& block, const Key& key) {
  return (key.group.empty() ? std::string(block.name) : group_path_of(block, key)) + "." + std::string(key.name);
}

std::string group_path_of(const Block& block, const Key& key) {
  return key.group.empty() ? "" : std::string(block.name) + "." + std::string(key.group);
}

std::string rule_of_group(std::string_view path) {
  std::string names;
  for (const Block& block : schema()) {
    for (const Key& key : block.keys) {
      if (key.group.empty() || group_path_of(block, key) != path) continue;
      names.append(names.empty() ? "a map of " : ", ").append(key.name);
    }
  }
  return names;
}

std::string rule_of(const Key& key) {
  Parameters somewhere;
  const Field field = key.field(somewhere);
  const auto number = [&](auto*) { return range_of(key, "a number"); };
  const auto whole = [&](auto*) { return range_of(key, "a whole number"); };
  const auto word = [&](auto*) {
    std::string rule = "one of ";
    for (const Word& allowed : words_of(field)) {
      if (allowed.now.empty()) rule += std::string(allowed.text) + ", ";
    }
    return rule.substr(0, rule.size() - 2);
  };
  return std::visit(
      Cases{
          [&](double* to) { return number(to); }, [&](std::optional<double>* to) { return number(to); },
          [&](Vector3*) { return range_of(key, "a list of three numbers, each"); },
          [&](std::optional<Vector3>*) { return range_of(key, "a list of three numbers, each"); },
          [&](std::optional<CovarianceDiagonal>*) { return range_of(key, "a list of six numbers, each"); },
          [&](std::int64_t* to) { return whole(to); }, [&](std::uint64_t* to) { return whole(to); },
          [&](bool*) { return std::string("true or false"); },
          [&](std::string*) {
            const std::string noun = (key.traits & kPath) != 0 ? "a path" : "a text";
            return (key.traits & kMayBeEmpty) != 0 ? noun + ", \"\" = none" : noun + ", not empty";
          },
          [&](std::vector<std::string>*) { return std::string("a name or a list of names, [] = found in the URDF"); },
          [&](auto* to) { return word(to); },  // the enums
      },
      field);
}

}  // namespace robot_control
