#include "telemetry/columns.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "signals/names.h"
#include "signals/rotation.h"

namespace robot_control {
namespace {

template <class Part>
const Part& part_of(const JoinedRow& row) {
  if constexpr (std::is_same_v<Part, DriverTrace>) return *row.driver;
  if constexpr (std::is_same_v<Part, EstimatorTrace>) return *row.estimator;
  if constexpr (std::is_same_v<Part, ControllerTrace>) return *row.controller;
  if constexpr (std::is_same_v<Part, MonitorTrace>) return *row.monitor;
  if constexpr (std::is_same_v<Part, JoinedRow>) return row;
}

template <class Part>
constexpr ColumnSource source_of() {
  if (std::is_same_v<Part, DriverTrace>) return ColumnSource::kDriver;
  if (std::is_same_v<Part, EstimatorTrace>) return ColumnSource::kEstimator;
  if (std::is_same_v<Part, ControllerTrace>) return ColumnSource::kController;
  if (std::is_same_v<Part, MonitorTrace>) return ColumnSource::kMonitor;
  return ColumnSource::kRow;
}

// `get` is a stateless lambda over one part and a joint; what it returns decides real or integer.
template <class Part, class Get>
Column column(std::string name, std::string unit, Get, std::size_t joint = 0) {
  using Value = std::invoke_result_t<Get, const Part&, std::size_t>;
  Column result;
  result.name = std::move(name);
  result.unit = std::move(unit);
  result.source = source_of<Part>();
  result.joint = joint;
  if constexpr (std::is_floating_point_v<Value>) {
    result.real = [](const JoinedRow& row, std::size_t j) -> double { return Get{}(part_of<Part>(row), j); };
  } else {
    result.integer = [](const JoinedRow& row, std::size_t j) {
      return static_cast<std::int64_t>(Get{}(part_of<Part>(row), j));
    };
  }
  return result;
}

/// Between the vertical of the start pose and the base's.
double tilt_of(const Quaternion& q) {
  return 2 * std::asin(std::min(1.0, std::hypot(q[0], q[1])));
}

double where(bool there, double value) {
  return there ? value : std::numeric_limits<double>::quiet_NaN();
}

double speed_limit_of(const Permit& permit) {
  return where(permit.speed_limit < kNoSpeedLimit, permit.speed_limit);
}

bool has_evidence(const Permit& permit) {
  return permit.evidence[0].cause != 0;
}

using D = DriverTrace;
using E = EstimatorTrace;
using C = ControllerTrace;
using M = MonitorTrace;
using J = std::size_t;
using Columns = std::vector<Column>;

void add_row(Columns& to) {
  to.push_back(column<JoinedRow>("run", "", [](const JoinedRow& row, J) { return row.run; }));
  to.push_back(column<JoinedRow>("cycle", "", [](const JoinedRow& row, J) { return row.cycle; }));
  to.push_back(column<JoinedRow>("time", "s", [](const JoinedRow& row, J) { return row.time; }));
}

void add_truth(Columns& to) {
  to.push_back(column<D>("truth_x", "m", [](const D& d, J) { return d.truth.pose_world.position[0]; }));
  to.push_back(column<D>("truth_y", "m", [](const D& d, J) { return d.truth.pose_world.position[1]; }));
  to.push_back(column<D>("truth_yaw", "rad", [](const D& d, J) { return yaw_of(d.truth.pose_world.orientation); }));
  to.push_back(column<D>("truth_tilt", "rad", [](const D& d, J) { return tilt_of(d.truth.pose_world.orientation); }));
  to.push_back(column<D>("truth_linear", "m/s", [](const D& d, J) { return d.truth.twist_base.linear[0]; }));
  to.push_back(column<D>("truth_angular", "rad/s", [](const D& d, J) { return d.truth.twist_base.angular[2]; }));
}

void add_estimate(Columns& to) {
  constexpr std::size_t kYaw = 5;  // Matrix6: x, y, z, roll, pitch, yaw
  to.push_back(column<E>("estimate_x", "m", [](const E& e, J) { return e.state.pose_odom.position[0]; }));
  to.push_back(column<E>("estimate_y", "m", [](const E& e, J) { return e.state.pose_odom.position[1]; }));
  to.push_back(column<E>("estimate_yaw", "rad", [](const E& e, J) { return yaw_of(e.state.pose_odom.orientation); }));
  to.push_back(column<E>("estimate_linear", "m/s", [](const E& e, J) { return e.state.twist_base.linear[0]; }));
  to.push_back(column<E>("estimate_angular", "rad/s", [](const E& e, J) { return e.state.twist_base.angular[2]; }));
  to.push_back(column<E>("estimate_x_variance", "m²", [](const E& e, J) { return e.state.pose_covariance[0]; }));
  to.push_back(column<E>("estimate_y_variance", "m²", [](const E& e, J) { return e.state.pose_covariance[7]; }));
  to.push_back(column<E>("estimate_yaw_variance", "rad²",
                         [](const E& e, J) { return e.state.pose_covariance[kYaw * 6 + kYaw]; }));
  to.push_back(column<E>("estimate_xy_covariance", "m²", [](const E& e, J) { return e.state.pose_covariance[1]; }));
  to.push_back(
      column<E>("estimate_x_yaw_covariance", "m·rad", [](const E& e, J) { return e.state.pose_covariance[kYaw]; }));
  to.push_back(
      column<E>("estimate_y_yaw_covariance", "m·rad", [](const E& e, J) { return e.state.pose_covariance[6 + kYaw]; }));
  to.push_back(
      column<E>("estimate_linear_variance", "m²/s²", [](const E& e, J) { return e.state.twist_covariance[0]; }));
  to.push_back(column<E>("estimate_angular_variance", "rad²/s²",
                         [](const E& e, J) { return e.state.twist_covariance[kYaw * 6 + kYaw]; }));
  to.push_back(column<E>("estimate_linear_angular_covariance", "m·rad/s²",
                         [](const E& e, J) { return e.state.twist_covariance[kYaw]; }));
  to.push_back(column<E>("estimate_lateral", "m/s", [](const E& e, J) { return e.state.twist_base.linear[1]; }));
  to.push_back(
      column<E>("estimate_lateral_variance", "m²/s²", [](const E& e, J) { return e.state.twist_covariance[7]; }));
  to.push_back(column<E>("estimate_z", "m", [](const E& e, J) { return e.state.pose_odom.position[2]; }));
  to.push_back(column<E>("estimate_roll", "rad", [](const E& e, J) { return roll_of(e.state.attitude); }));
  to.push_back(column<E>("estimate_pitch", "rad", [](const E& e, J) { return pitch_of(e.state.attitude); }));
  to.push_back(column<E>("estimate_flags", "StateFlag", [](const E& e, J) { return e.state.flags; }));
  to.push_back(column<E>("estimate_slip", "SlipReason", [](const E& e, J) { return e.state.slip; }));
  to.push_back(column<E>("estimate_distance", "m", [](const E& e, J) { return e.state.distance; }));
  to.push_back(column<E>("estimate_skipped", "", [](const E& e, J) { return e.state.skipped; }));
}

// How far each sensor and the ground agree with the rest, and what was learned of them.
void add_trust(Columns& to) {
  for (std::size_t i = 0; i < kStateSensorNames.size(); ++i) {
    const std::string sensor(kStateSensorNames[i]);
    to.push_back(column<E>(
        "confidence_" + sensor, "0…1", [](const E& e, J j) { return e.state.confidence[j]; }, i));
    to.push_back(column<E>(
        "nis_" + sensor, "", [](const E& e, J j) { return e.state.nis[j]; }, i));
    to.push_back(column<E>(
        "rejected_" + sensor, "", [](const E& e, J j) { return e.state.rejected[j]; }, i));
  }
  to.push_back(column<E>("radius_ratio", "", [](const E& e, J) { return e.state.calibration.radius_ratio; }));
  to.push_back(column<E>("radius_ratio_deviation", "",
                         [](const E& e, J) { return e.state.calibration.radius_ratio_deviation; }));
  to.push_back(column<E>("wheel_base_factor", "", [](const E& e, J) { return e.state.calibration.wheel_base_factor; }));
  to.push_back(
      column<E>("wheel_base_deviation", "", [](const E& e, J) { return e.state.calibration.wheel_base_deviation; }));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string name = std::string("gyro_bias_") + "xyz"[axis];
    to.push_back(column<E>(
        name, "rad/s", [](const E& e, J j) { return e.state.gyro_bias[j]; }, axis));
    to.push_back(column<E>(
        name + "_deviation", "rad/s", [](const E& e, J j) { return e.state.gyro_bias_deviation[j]; }, axis));
  }
}

void add_wheel_odometry(Columns& to) {
  to.push_back(column<E>("wheel_odom_x", "m", [](const E& e, J) { return e.state.wheels.x; }));
  to.push_back(column<E>("wheel_odom_y", "m", [](const E& e, J) { return e.state.wheels.y; }));
  to.push_back(column<E>("wheel_odom_yaw", "rad", [](const E& e, J) { return e.state.wheels.yaw; }));
  to.push_back(column<E>("wheel_odom_linear", "m/s", [](const E& e, J) { return e.state.wheels.linear; }));
  to.push_back(column<E>("wheel_odom_angular", "rad/s", [](const E& e, J) { return e.state.wheels.angular; }));
}

void add_command(Columns& to) {
  to.push_back(column<C>("requested_linear", "m/s", [](const C& c, J) { return c.command.twist_requested.linear[0]; }));
  to.push_back(
      column<C>("requested_angular", "rad/s", [](const C& c, J) { return c.command.twist_requested.angular[2]; }));
  to.push_back(column<C>("limited_linear", "m/s", [](const C& c, J) { return c.command.twist_limited.linear[0]; }));
  to.push_back(column<C>("limited_angular", "rad/s", [](const C& c, J) { return c.command.twist_limited.angular[2]; }));
  to.push_back(column<C>("command_reasons", "CommandReason", [](const C& c, J) { return c.command.reasons; }));
  to.push_back(column<C>("requests_received", "", [](const C& c, J) { return c.command.requests_received; }));
  to.push_back(column<C>("requests_refused", "", [](const C& c, J) { return c.command.requests_refused; }));
  to.push_back(column<C>("requests_stale", "", [](const C& c, J) { return c.command.requests_stale; }));
  to.push_back(column<C>("requests_crowded", "", [](const C& c, J) { return c.command.requests_crowded; }));
  to.push_back(column<C>("timeouts", "", [](const C& c, J) { return c.command.timeouts; }));
}

// Named as the parameters.
void add_tuning(Columns& to) {
  to.push_back(column<C>("tuning", "", [](const C& c, J) { return c.tuning.count; }));
  to.push_back(column<C>("max_linear_speed", "m/s", [](const C& c, J) { return c.tuning.linear.speed; }));
  to.push_back(column<C>("max_angular_speed", "rad/s", [](const C& c, J) { return c.tuning.angular.speed; }));
  to.push_back(
      column<C>("max_linear_acceleration", "m/s²", [](const C& c, J) { return c.tuning.linear.acceleration; }));
  to.push_back(
      column<C>("max_angular_acceleration", "rad/s²", [](const C& c, J) { return c.tuning.angular.acceleration; }));
  to.push_back(
      column<C>("max_linear_deceleration", "m/s²", [](const C& c, J) { return c.tuning.linear.deceleration; }));
  to.push_back(
      column<C>("max_angular_deceleration", "rad/s²", [](const C& c, J) { return c.tuning.angular.deceleration; }));
  to.push_back(column<C>("max_linear_emergency_deceleration", "m/s²",
                         [](const C& c, J) { return c.tuning.linear.emergency_deceleration; }));
  to.push_back(column<C>("max_angular_emergency_deceleration", "rad/s²",
                         [](const C& c, J) { return c.tuning.angular.emergency_deceleration; }));
  to.push_back(column<C>("max_linear_jerk", "m/s³", [](const C& c, J) { return c.tuning.linear.jerk; }));
  to.push_back(column<C>("max_angular_jerk", "rad/s³", [](const C& c, J) { return c.tuning.angular.jerk; }));
  to.push_back(column<C>("min_linear_speed", "m/s", [](const C& c, J) { return -c.tuning.linear.reverse_speed; }));
  to.push_back(column<C>("max_linear_acceleration_reverse", "m/s²",
                         [](const C& c, J) { return c.tuning.linear.reverse_acceleration; }));
  to.push_back(column<C>("max_linear_deceleration_reverse", "m/s²",
                         [](const C& c, J) { return c.tuning.linear.reverse_deceleration; }));
  to.push_back(column<C>("keep_curvature", "", [](const C& c, J) { return c.tuning.keep_curvature; }));
  to.push_back(column<C>("cmd_vel_timeout", "s", [](const C& c, J) { return c.tuning.cmd_vel_timeout; }));
  to.push_back(column<C>("tracking_bandwidth", "Hz", [](const C& c, J) { return c.tuning.tracking_bandwidth; }));
  to.push_back(column<C>("feed_forward_mass", "kg", [](const C& c, J) { return c.tuning.mass; }));
  to.push_back(column<C>("feed_forward_yaw_inertia", "kg·m²", [](const C& c, J) { return c.tuning.yaw_inertia; }));
}

void add_wheel_tuning(Columns& to, const std::string& name, std::size_t joint) {
  to.push_back(column<C>(
      name + "_pid_kp", "N·m·s/rad", [](const C& c, J j) { return c.tuning.wheels[j].kp; }, joint));
  to.push_back(column<C>(
      name + "_pid_ki", "N·m/rad", [](const C& c, J j) { return c.tuning.wheels[j].ki; }, joint));
  to.push_back(column<C>(
      name + "_pid_kd", "N·m·s²/rad", [](const C& c, J j) { return c.tuning.wheels[j].kd; }, joint));
  to.push_back(column<C>(
      name + "_feed_forward_inertia", "kg·m²", [](const C& c, J j) { return c.tuning.wheels[j].inertia; }, joint));
  to.push_back(column<C>(
      name + "_feed_forward_damping", "N·m·s/rad", [](const C& c, J j) { return c.tuning.wheels[j].damping; }, joint));
  to.push_back(column<C>(
      name + "_feed_forward_friction", "N·m", [](const C& c, J j) { return c.tuning.wheels[j].friction; }, joint));
}

void add_joint(Columns& to, const std::string& name, std::size_t joint) {
  to.push_back(column<D>(
      name + "_position", "rad", [](const D& d, J j) { return d.sensors.joints[j].position; }, joint));
  to.push_back(column<D>(
      name + "_velocity", "rad/s", [](const D& d, J j) { return d.sensors.joints[j].velocity; }, joint));
  to.push_back(column<D>(
      name + "_effort", "N·m", [](const D& d, J j) { return d.sensors.joints[j].effort; }, joint));
  to.push_back(column<C>(
      name + "_mode", "JointMode", [](const C& c, J j) { return c.command.joints[j].mode; }, joint));
  to.push_back(column<C>(
      name + "_effort_command", "N·m", [](const C& c, J j) { return c.command.joints[j].effort; }, joint));
  to.push_back(column<C>(
      name + "_velocity_command", "rad/s", [](const C& c, J j) { return c.command.joints[j].velocity; }, joint));
  to.push_back(column<C>(
      name + "_velocity_measured", "rad/s", [](const C& c, J j) { return c.command.velocity_measured[j]; }, joint));
}

void add_imu(Columns& to) {
  to.push_back(column<D>("gyro_x", "rad/s", [](const D& d, J) { return d.sensors.imu.angular_velocity[0]; }));
  to.push_back(column<D>("gyro_y", "rad/s", [](const D& d, J) { return d.sensors.imu.angular_velocity[1]; }));
  to.push_back(column<D>("gyro_z", "rad/s", [](const D& d, J) { return d.sensors.imu.angular_velocity[2]; }));
  to.push_back(column<D>("accel_x", "m/s²", [](const D& d, J) { return d.sensors.imu.linear_acceleration[0]; }));
  to.push_back(column<D>("accel_y", "m/s²", [](const D& d, J) { return d.sensors.imu.linear_acceleration[1]; }));
  to.push_back(column<D>("accel_z", "m/s²", [](const D& d, J) { return d.sensors.imu.linear_acceleration[2]; }));
}

void add_safety(Columns& to) {
  to.push_back(column<M>("permit_action", "PermitAction", [](const M& m, J) { return m.permit.action; }));
  to.push_back(column<M>("supervisor_state", "SupervisorState", [](const M& m, J) { return m.permit.state; }));
  to.push_back(column<M>("permit_causes", "StopCause", [](const M& m, J) { return m.permit.causes; }));
  to.push_back(column<M>("permit_active", "StopCause", [](const M& m, J) { return m.permit.active; }));
  to.push_back(column<M>("permit_warnings", "StopCause", [](const M& m, J) { return m.permit.warnings; }));
  to.push_back(column<M>("speed_limit", "m/s", [](const M& m, J) { return speed_limit_of(m.permit); }));
  to.push_back(column<M>("evidence_cause", "StopCause", [](const M& m, J) { return m.permit.evidence[0].cause; }));
  to.push_back(column<M>("evidence_value", "cause_names.h",
                         [](const M& m, J) { return where(has_evidence(m.permit), m.permit.evidence[0].value); }));
  to.push_back(column<M>("evidence_limit", "cause_names.h",
                         [](const M& m, J) { return where(has_evidence(m.permit), m.permit.evidence[0].limit); }));
  to.push_back(column<M>("permit_missing", "MissingNode", [](const M& m, J) { return m.permit.missing; }));
  to.push_back(column<M>("reset_refusal", "ResetRefusal", [](const M& m, J) { return m.permit.reset_refusal; }));
  to.push_back(column<D>("gate_verdict", "GateVerdict", [](const D& d, J) { return d.gate.verdict; }));
  to.push_back(column<D>("gate_reasons", "GateReason", [](const D& d, J) { return d.gate.reasons; }));
  to.push_back(column<D>("gate_command_cycle", "", [](const D& d, J) { return d.gate.command_cycle; }));
  to.push_back(column<D>("gate_permit_cycle", "", [](const D& d, J) { return d.gate.permit_cycle; }));
  to.push_back(column<D>("held", "", [](const D& d, J) { return d.gate.held; }));
  to.push_back(column<D>("missed", "", [](const D& d, J) { return d.gate.missed; }));
  to.push_back(column<D>("late_permits", "", [](const D& d, J) { return d.gate.late_permits; }));
  to.push_back(column<D>("refused", "", [](const D& d, J) { return d.gate.refused; }));
  to.push_back(column<D>("driver_state", "DriverState", [](const D& d, J) { return d.sensors.driver_state; }));
  to.push_back(column<D>("faults", "DriverFault", [](const D& d, J) { return d.sensors.faults; }));
  to.push_back(column<D>("battery_voltage", "V", [](const D& d, J) {
    return where((d.sensors.valid & kValidBattery) != 0, d.sensors.battery_voltage);
  }));
  to.push_back(column<D>("injected", "fault_code", [](const D& d, J) { return fault_code(d.sensors.injected); }));
}

void add_timing(Columns& to) {
  const std::size_t first = to.size();
  to.push_back(column<D>("stamp_ns", "ns", [](const D& d, J) { return d.sensors.head.stamp_ns; }));
  to.push_back(column<D>("driver_woke_ns", "ns", [](const D& d, J) { return d.timing.woke_ns; }));
  to.push_back(column<D>("sensors_published_ns", "ns", [](const D& d, J) { return d.timing.published_ns; }));
  to.push_back(column<E>("estimator_woke_ns", "ns", [](const E& e, J) { return e.timing.woke_ns; }));
  to.push_back(column<E>("state_published_ns", "ns", [](const E& e, J) { return e.timing.published_ns; }));
  to.push_back(column<C>("controller_woke_ns", "ns", [](const C& c, J) { return c.timing.woke_ns; }));
  to.push_back(column<C>("command_published_ns", "ns", [](const C& c, J) { return c.timing.published_ns; }));
  to.push_back(column<M>("monitor_woke_ns", "ns", [](const M& m, J) { return m.timing.woke_ns; }));
  to.push_back(column<M>("permit_published_ns", "ns", [](const M& m, J) { return m.timing.published_ns; }));
  to.push_back(column<D>("overruns", "", [](const D& d, J) { return d.sensors.overruns; }));
  to.push_back(column<D>("slipped_ns", "ns", [](const D& d, J) { return d.sensors.slipped_ns; }));
  for (std::size_t i = first; i < to.size(); ++i) to[i].kind = ColumnKind::kTiming;
}

}  // namespace

PresentSources present_sources(const JoinedRow& row) noexcept {
  return {true, row.driver != nullptr, row.estimator != nullptr, row.controller != nullptr, row.monitor != nullptr};
}

std::vector<Column> log_columns(const std::vector<std::string>& joints, bool timing) {
  Columns columns;
  add_row(columns);
  add_truth(columns);
  add_estimate(columns);
  add_trust(columns);
  add_wheel_odometry(columns);
  add_command(columns);
  for (std::size_t j = 0; j < joints.size(); ++j) add_joint(columns, joints[j], j);
  add_tuning(columns);
  for (std::size_t j = 0; j < std::min(joints.size(), kTunedWheels); ++j) add_wheel_tuning(columns, joints[j], j);
  add_imu(columns);
  add_safety(columns);
  if (timing) add_timing(columns);
  return columns;
}

}  // namespace robot_control
