#include <algorithm>

#include "log/fields/trace_field_groups.h"
#include "log/fields/trace_field_kinds.h"
#include "signals/names.h"

namespace robot_control {

using namespace trace_words;

void add_estimate(TraceFields& to) {
  field<E, f64>(to, "estimate_position", "m, base_link in odom", MEMBER(state.base.pose_odom.position))
      .shown({"estimate_x", "estimate_y", "estimate_z"});
  field<E, f32>(to, "estimate_orientation", "x, y, z, w", MEMBER(state.base.pose_odom.orientation));
  yaw<E>(to, "estimate_yaw", MEMBER(state.base.pose_odom.orientation)).shown();
  field<E, f32>(to, "estimate_linear", "m/s, base axes", MEMBER(state.base.twist_base.linear))
      .shown({"estimate_linear", "estimate_lateral"});
  field<E, f32>(to, "estimate_angular", "rad/s, base axes", MEMBER(state.base.twist_base.angular))
      .shown_as(column<E>("estimate_angular", "rad/s",
                          [](const E& e, std::size_t) { return e.state.base.twist_base.angular[2]; }));
  field<E, f32>(to, "estimate_attitude", "x, y, z, w; base axes to odom axes, z against gravity",
                MEMBER(state.base.attitude))
      .shown_as(
          column<E>("estimate_roll", "rad", [](const E& e, std::size_t) { return roll_of(e.state.base.attitude); }))
      .shown_as(
          column<E>("estimate_pitch", "rad", [](const E& e, std::size_t) { return pitch_of(e.state.base.attitude); }));
  const auto entry = [&](const char* name, const char* unit, auto get) {
    field<E, f32>(to, name, unit, get).shown().as_part();
  };
  entry("estimate_x_variance", "m^2", MEMBER(state.base.pose_covariance[0]));
  entry("estimate_y_variance", "m^2", MEMBER(state.base.pose_covariance[7]));
  entry("estimate_yaw_variance", "rad^2", MEMBER(state.base.pose_covariance[35]));
  entry("estimate_xy_covariance", "m^2", MEMBER(state.base.pose_covariance[1]));
  entry("estimate_x_yaw_covariance", "m*rad", MEMBER(state.base.pose_covariance[5]));
  entry("estimate_y_yaw_covariance", "m*rad", MEMBER(state.base.pose_covariance[11]));
  entry("estimate_linear_variance", "m^2/s^2", MEMBER(state.base.twist_covariance[0]));
  entry("estimate_lateral_variance", "m^2/s^2", MEMBER(state.base.twist_covariance[7]));
  entry("estimate_angular_variance", "rad^2/s^2", MEMBER(state.base.twist_covariance[35]));
  entry("estimate_linear_angular_covariance", "m*rad/s^2", MEMBER(state.base.twist_covariance[5]));
  per_joint<E, f32>(to, "estimate_joint_velocity", "rad/s or m/s", ELEMENT(state.joint_velocity[i]))
      .shown_per_joint("estimate_velocity");
  static constexpr auto kContacts = [](const E* estimator, std::size_t) {
    return estimator == nullptr ? 0 : std::min<std::size_t>(estimator->state.contact_count, kMaxContacts);
  };
  field<E, u64>(to, "estimate_contact_count", "contacts estimated", MEMBER(state.contact_count));
  list<E, f32, kMaxContacts>(to, "estimate_contact_probability", "0 (not trusted) ... 1", kContacts,
                             ELEMENT(state.contacts[i].probability))
      .shown_per_contact();
  list<E, f32, kMaxContacts>(to, "estimate_contact_slip", "m/s, over the ground, along the wheel", kContacts,
                             ELEMENT(state.contacts[i].slip));
  list<E, f32, kMaxContacts>(to, "estimate_contact_load", "N, upwards", kContacts, ELEMENT(state.contacts[i].load))
      .shown_per_contact();
  field<E, f64>(to, "estimate_distance", "m travelled in this run", MEMBER(state.base.distance)).shown();
  field<E, f64>(to, "wheel_odom_x", "m, the wheels alone by the model's numbers", MEMBER(state.wheeled.odometry.x))
      .shown();
  field<E, f64>(to, "wheel_odom_y", "m", MEMBER(state.wheeled.odometry.y)).shown();
  field<E, f32>(to, "wheel_odom_yaw", "rad", MEMBER(state.wheeled.odometry.yaw)).shown();
  field<E, f32>(to, "wheel_odom_linear", "m/s", MEMBER(state.wheeled.odometry.linear)).shown();
  field<E, f32>(to, "wheel_odom_angular", "rad/s", MEMBER(state.wheeled.odometry.angular)).shown();
}

void add_trust(TraceFields& to) {
  const auto names = [](const std::string& quantity) {
    std::vector<std::string> result;
    for (const std::string_view sensor : kStateSensorNames) result.push_back(quantity + "_" + std::string(sensor));
    return result;
  };
  field<E, f32>(to, "nis", "normalised innovation squared per degree of freedom, by SensorIndex; ideal 1",
                MEMBER(state.wheeled.nis))
      .shown(names("nis"));
  field<E, f32>(to, "confidence", "0 (not used) ... 1 (agrees), by SensorIndex", MEMBER(state.wheeled.confidence))
      .shown(names("confidence"));
  field<E, u64>(to, "rejected", "comparisons of this run beyond their gate, by SensorIndex",
                MEMBER(state.wheeled.rejected))
      .shown(names("rejected"));
  field<E, f32>(to, "gyro_bias", "rad/s, IMU axes", MEMBER(state.base.gyro_bias))
      .shown({"gyro_bias_x", "gyro_bias_y", "gyro_bias_z"});
  field<E, f32>(to, "gyro_bias_deviation", "rad/s, IMU axes", MEMBER(state.base.gyro_bias_deviation))
      .shown({"gyro_bias_x_deviation", "gyro_bias_y_deviation", "gyro_bias_z_deviation"});
  field<E, f32>(to, "accelerometer_bias", "m/s^2, IMU axes", MEMBER(state.base.accelerometer_bias));
  field<E, f64>(to, "radius_ratio", "right over left wheel radius", MEMBER(state.wheeled.calibration.radius_ratio))
      .shown();
  field<E, f32>(to, "radius_ratio_deviation", "standard deviation of radius_ratio",
                MEMBER(state.wheeled.calibration.radius_ratio_deviation))
      .shown();
  field<E, f64>(to, "wheel_base_factor", "effective over the model's wheel base",
                MEMBER(state.wheeled.calibration.wheel_base_factor))
      .shown();
  field<E, f32>(to, "wheel_base_deviation", "standard deviation of wheel_base_factor",
                MEMBER(state.wheeled.calibration.wheel_base_deviation))
      .shown();
  field<E, f32>(to, "residual_level", "wheels against accelerometer, over what the sensors' noise explains",
                MEMBER(state.wheeled.residual_level));
  field<E, u64>(to, "estimate_flags", "StateFlag bits", MEMBER(state.base.flags)).shown();
  field<E, u64>(to, "estimate_slip", "SlipReason bits", MEMBER(state.wheeled.slip)).shown();
  field<E, u64>(to, "estimate_degraded", "DegradedReason bits", MEMBER(state.base.degraded));
  field<E, u64>(to, "estimate_skipped", "sensor cycles of this run never seen", MEMBER(state.skipped)).shown();
  field<E, u64>(to, "estimate_first_cycle", "of this process in this run", MEMBER(state.first_cycle));
}

void add_frame_only_estimate(TraceFields& to) {
  field<E, f64>(to, "pose_covariance", "m^2, m*rad, rad^2", MEMBER(state.base.pose_covariance));
  field<E, f64>(to, "twist_covariance", "m^2/s^2, m*rad/s^2, rad^2/s^2", MEMBER(state.base.twist_covariance));
  field<E, f64>(to, "attitude_covariance", "rad^2", MEMBER(state.base.attitude_covariance));
}

}  // namespace robot_control
