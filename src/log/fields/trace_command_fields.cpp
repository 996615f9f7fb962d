#include "log/fields/trace_field_groups.h"
#include "log/fields/trace_field_kinds.h"
#include "signals/wheeled/drive_tuning.h"

namespace robot_control {

using namespace trace_words;

#define TUNING(member)                                  \
  [](auto& part) -> auto& {                             \
    return content_of<DriveTuning>(part.tuning).member; \
  }
#define WHEEL_TUNING(member)                                      \
  [](auto& part, std::size_t i) -> auto& {                        \
    return content_of<DriveTuning>(part.tuning).wheels[i].member; \
  }

namespace {

/// The list holds a value for each joint that may be that of a wheel.
template <class Part, class Wire, class Get>
TraceField& per_wheel(TraceFields& to, std::string_view name, std::string_view comment, Get get) {
  TraceField& result = list<Part, Wire, kMaxWheels>(
      to, name, comment, [](const Part*, std::size_t joints) { return std::min(joints, kMaxWheels); }, get);
  result.max_joints = kMaxWheels;
  return result;
}

void add_legs(TraceFields& to) {
  field<C, u64>(to, "legged_phase", "LegPhase", MEMBER(command.legged.phase)).shown();
  field<C, u64>(to, "legged_lifted", "1 + leg of the foot in the air; 0: none", MEMBER(command.legged.lifted));
  field<C, f32>(to, "legged_body", "m, rad: x y height roll pitch yaw from the nominal pose, after limits",
                MEMBER(command.legged.body));
  field<C, u64>(to, "legged_gait", "index of the robot's gaits; 0: stand", MEMBER(command.legged.gait)).shown();
  field<C, f64>(to, "legged_gait_phase", "0 to 1", MEMBER(command.legged.gait_phase)).shown();
  field<C, f32>(to, "legged_slope", "m/m: rise of the ground to the front and left", MEMBER(command.legged.slope))
      .shown({"slope_ahead", "slope_left"});
  field<C, u8>(to, "legged_risers", "bit per leg: its foot is lifted over an obstacle", MEMBER(command.legged.risers))
      .shown();
  field<C, u8>(to, "legged_reaches", "bit per leg: its foot finds no ground", MEMBER(command.legged.reaches)).shown();
  field<C, f64>(to, "contact_schedule", "by contact: part of its time on the ground; 0: it shall not bear",
                MEMBER(command.contact_schedule))
      .shown({"front_left_stance", "front_right_stance", "rear_left_stance", "rear_right_stance"});
}

}  // namespace

void add_command(TraceFields& to) {
  const auto number = [&](const char* name, const char* comment, auto get) { field<C, u64>(to, name, comment, get); };
  const auto shown = [&](const char* name, const char* comment, auto get) {
    field<C, u64>(to, name, comment, get).shown();
  };
  field<C, f64>(to, "requested_linear", "m/s, base axes, as last received", MEMBER(command.requested.twist.linear))
      .shown({"requested_linear", "requested_lateral"});
  field<C, f64>(to, "requested_angular", "rad/s, base axes", MEMBER(command.requested.twist.angular))
      .shown_as(column<C>("requested_angular", "rad/s",
                          [](const C& c, std::size_t) { return c.command.requested.twist.angular[2]; }));
  add_request(to, "requested", MEMBER(command.requested));
  shown("request_ignored", "RequestPart bits that the machine cannot execute", MEMBER(command.ignored));
  field<C, f32>(to, "limited_linear", "m/s, after limits", MEMBER(command.twist_limited.linear))
      .shown({"limited_linear", "limited_lateral"});
  field<C, f32>(to, "limited_angular", "rad/s, after limits", MEMBER(command.twist_limited.angular))
      .shown_as(column<C>("limited_angular", "rad/s",
                          [](const C& c, std::size_t) { return c.command.twist_limited.angular[2]; }));
  per_joint<C, f32>(to, "effort_command", "N*m or N", ELEMENT(command.joints[i].effort))
      .shown_per_joint("effort_command");
  per_joint<C, f32>(to, "velocity_command", "rad/s or m/s", ELEMENT(command.joints[i].velocity))
      .shown_per_joint("velocity_command");
  TraceColumn measured = column<C>(
      "velocity_measured", "rad/s, of the tracking loop; 0: no wheel",
      [](const C& c, std::size_t joint) { return joint < kMaxWheels ? c.command.wheeled.velocity[joint] : 0; });
  measured.owner = TraceColumn::Owner::kJoint;
  per_wheel<C, f32>(to, "velocity_measured", "rad/s, of the tracking loop", ELEMENT(command.wheeled.velocity[i]))
      .shown_as(measured);
  to.back().max_joints = kMaxJoints;
  per_joint<C, u8>(to, "mode_command", "JointMode", ELEMENT(command.joints[i].mode)).shown_per_joint("mode");
  number("command_state_cycle", "of the state used", MEMBER(command.state_cycle));
  number("command_permit_cycle", "of the permit used", MEMBER(command.permit_cycle));
  number("silent_cycles", "since the last message of any sender", MEMBER(command.silent_cycles));
  number("command_joint_count", "", MEMBER(command.joint_count));
  number("stop_profile", "by which the gate stops after this command", MEMBER(command.stop_profile));
  shown("command_reasons", "CommandReason bits, and those of the kind of robot", MEMBER(command.reasons));
  add_legs(to);
  number("request_cycle", "in which the last command was received", MEMBER(command.request_cycle));
  shown("requests_received", "in this run", MEMBER(command.requests_received));
  shown("requests_refused", "in this run", MEMBER(command.requests_refused));
  shown("requests_stale", "of these, for their stamp", MEMBER(command.requests_stale));
  shown("requests_crowded", "of these, while more than one node sent", MEMBER(command.requests_crowded));
  number("requests_revoked", "of these, of senders that owe a zero velocity", MEMBER(command.requests_revoked));
  shown("requests_partial", "accepted with a part that the machine ignores", MEMBER(command.requests_partial));
  shown("timeouts", "in this run", MEMBER(command.timeouts));
  number("command_first_cycle", "of this process in this run", MEMBER(command.first_cycle));
  number("zero_requests", "zero velocities accepted since then", MEMBER(command.zero_requests));
  number("zero_requested", "1: nothing else since the last of them", MEMBER(command.zero_requested));
  number("silence_needed", "cycles", MEMBER(command.silence_needed));
}

void add_frame_only_command(TraceFields& to) {
  per_joint<C, f64>(to, "position_command", "rad or m", ELEMENT(command.joints[i].position));
  per_joint<C, f64>(to, "stiffness_command", "N*m/rad or N/m", ELEMENT(command.joints[i].stiffness));
  per_joint<C, f64>(to, "damping_command", "N*m*s/rad or N*s/m", ELEMENT(command.joints[i].damping));
}

void add_tuning(TraceFields& to) {
  const auto number = [&](const char* name, const char* unit, auto get) { field<C, f64>(to, name, unit, get).shown(); };
  field<C, u64>(to, "tuning", "sets of live parameters accepted; what follows was in force", TUNING(count)).shown();
  number("max_linear_speed", "m/s", TUNING(linear.speed));
  number("max_linear_acceleration", "m/s^2", TUNING(linear.acceleration));
  number("max_linear_deceleration", "m/s^2", TUNING(linear.deceleration));
  number("max_linear_emergency_deceleration", "m/s^2", TUNING(linear.emergency_deceleration));
  number("max_linear_jerk", "m/s^3, 0: none", TUNING(linear.jerk));
  field<C, f64>(to, "linear_reverse_speed", "m/s, backwards", TUNING(linear.reverse_speed))
      .shown_as(column<C>("min_linear_speed", "m/s, at most 0", [](const C& c, std::size_t) {
        return -content_of<DriveTuning>(c.tuning).linear.reverse_speed;
      }));
  number("max_linear_acceleration_reverse", "m/s^2", TUNING(linear.reverse_acceleration));
  number("max_linear_deceleration_reverse", "m/s^2", TUNING(linear.reverse_deceleration));
  number("max_angular_speed", "rad/s", TUNING(angular.speed));
  number("max_angular_acceleration", "rad/s^2", TUNING(angular.acceleration));
  number("max_angular_deceleration", "rad/s^2", TUNING(angular.deceleration));
  number("max_angular_emergency_deceleration", "rad/s^2", TUNING(angular.emergency_deceleration));
  number("max_angular_jerk", "rad/s^3, 0: none", TUNING(angular.jerk));
  field<C, f64>(to, "angular_reverse_speed", "rad/s", TUNING(angular.reverse_speed));
  field<C, f64>(to, "angular_reverse_acceleration", "rad/s^2", TUNING(angular.reverse_acceleration));
  field<C, f64>(to, "angular_reverse_deceleration", "rad/s^2", TUNING(angular.reverse_deceleration));
  field<C, u64>(to, "keep_curvature", "1: kept", TUNING(keep_curvature)).shown();
  number("cmd_vel_timeout", "s, 0: never", TUNING(cmd_vel_timeout));
  number("tracking_bandwidth", "Hz", TUNING(tracking_bandwidth));
  number("feed_forward_mass", "kg", TUNING(mass));
  number("feed_forward_yaw_inertia", "kg*m^2", TUNING(yaw_inertia));
  per_wheel<C, f64>(to, "pid_kp", "N*m*s/rad", WHEEL_TUNING(kp)).shown_per_joint("pid_kp");
  per_wheel<C, f64>(to, "pid_ki", "N*m/rad", WHEEL_TUNING(ki)).shown_per_joint("pid_ki");
  per_wheel<C, f64>(to, "pid_kd", "N*m*s^2/rad", WHEEL_TUNING(kd)).shown_per_joint("pid_kd");
  per_wheel<C, f64>(to, "model_inertia", "kg*m^2, of the tracking loop", WHEEL_TUNING(model_inertia));
  per_wheel<C, f64>(to, "feed_forward_inertia", "kg*m^2", WHEEL_TUNING(inertia))
      .shown_per_joint("feed_forward_inertia");
  per_wheel<C, f64>(to, "feed_forward_damping", "N*m*s/rad", WHEEL_TUNING(damping))
      .shown_per_joint("feed_forward_damping");
  per_wheel<C, f64>(to, "feed_forward_friction", "N*m", WHEEL_TUNING(friction))
      .shown_per_joint("feed_forward_friction");
}

}  // namespace robot_control
