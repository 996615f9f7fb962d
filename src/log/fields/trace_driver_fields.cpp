#include <algorithm>
#include <cmath>

#include "log/fields/trace_field_groups.h"
#include "log/fields/trace_field_kinds.h"

namespace robot_control {

using namespace trace_words;

namespace {

/// The angle between the vertical of the start pose and that of the base.
double tilt_of(const Quaternion& q) {
  return 2 * std::asin(std::min(1.0, std::hypot(q[0], q[1])));
}

constexpr auto kContacts = [](const D*, std::size_t) { return kMaxContacts; };

}  // namespace

void add_sensors(TraceFields& to) {
  per_joint<D, f64>(to, "joint_position", "rad or m, at t_k", ELEMENT(sensors.joints[i].position))
      .shown_per_joint("position");
  per_joint<D, f64>(to, "joint_velocity", "rad/s or m/s, at t_k", ELEMENT(sensors.joints[i].velocity))
      .shown_per_joint("velocity");
  per_joint<D, f64>(to, "joint_effort", "N*m or N, the mean applied over [t_k-1, t_k)",
                    ELEMENT(sensors.joints[i].effort))
      .shown_per_joint("effort");
  field<D, f64>(to, "gyro", "rad/s, IMU axes, at t_k", MEMBER(sensors.imu.angular_velocity))
      .shown({"gyro_x", "gyro_y", "gyro_z"});
  field<D, f64>(to, "accel", "m/s^2, IMU axes, specific force over [t_k-1, t_k)",
                MEMBER(sensors.imu.linear_acceleration))
      .shown({"accel_x", "accel_y", "accel_z"});
  field<D, f64>(to, "battery_voltage", "V, at the terminals", MEMBER(sensors.battery_voltage))
      .shown_as(column<D>("battery_voltage", "V; NaN: not measured", [](const D& d, std::size_t) {
        return where((d.sensors.valid & kValidBattery) != 0, d.sensors.battery_voltage);
      }));
  field<D, f64>(to, "battery_current", "A, positive when discharging", MEMBER(sensors.battery_current));
  field<D, f64>(to, "imu_orientation", "x, y, z, w; zero where the device has none", MEMBER(sensors.imu.orientation));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string name = std::string("contact_force_") + "xyz"[axis];
    const std::string comment = "N, on the machine, base axes, mean over [t_k-1, t_k): wheels, then casters";
    if (axis == 0) {
      list<D, f64, kMaxContacts>(to, name, comment, kContacts, ELEMENT(sensors.contacts[i].force[0]));
    } else if (axis == 1) {
      list<D, f64, kMaxContacts>(to, name, comment, kContacts, ELEMENT(sensors.contacts[i].force[1]));
    } else {
      list<D, f64, kMaxContacts>(to, name, comment, kContacts, ELEMENT(sensors.contacts[i].force[2]));
    }
  }
  list<D, u8, kMaxContacts>(to, "contact_valid", "1: the force was measured", kContacts,
                            ELEMENT(sensors.contacts[i].valid));
  field<D, u64>(to, "contact_count", "contacts with a sensor", MEMBER(sensors.contact_count));
  per_joint<D, f64>(to, "joint_temperature", "degrees Celsius", ELEMENT(sensors.joints[i].temperature));
  per_joint<D, u8>(to, "joint_valid", "JointValidity bits", ELEMENT(sensors.joints[i].valid)).shown_per_joint("valid");
  TraceColumn age = column<D>("age", "s, from the sample of the drive to t_k", [](const D& d, std::size_t joint) {
    return 1e-9 * static_cast<double>(d.sensors.joints[joint].age_ns);
  });
  age.owner = TraceColumn::Owner::kJoint;
  per_joint<D, i64>(to, "joint_age_ns", "ns, from the sample of the drive to t_k", ELEMENT(sensors.joints[i].age_ns))
      .shown_as(age);
  per_joint<D, u32>(to, "joint_fault", "fault word of the drive", ELEMENT(sensors.joints[i].fault))
      .shown_per_joint("fault");
}

void add_links(TraceFields& to) {
  static constexpr auto kSize = [](const D*, std::size_t) { return kMaxLinks; };
  field<D, u64>(to, "link_count", "links of the driver to its devices", MEMBER(sensors.link_count));
  list<D, u8, kMaxLinks>(to, "link_state", "LinkState", kSize, ELEMENT(sensors.links[i].state));
  list<D, u64, kMaxLinks>(to, "link_sent", "messages of this run", kSize, ELEMENT(sensors.links[i].sent));
  list<D, u64, kMaxLinks>(to, "link_lost", "answers that never came", kSize, ELEMENT(sensors.links[i].lost));
  list<D, u64, kMaxLinks>(to, "link_late", "answers after the cycle in which they were due", kSize,
                          ELEMENT(sensors.links[i].late));
  list<D, u64, kMaxLinks>(to, "link_errors", "that the link reported", kSize, ELEMENT(sensors.links[i].errors));
}

namespace {

/// Returns the column that shows the FaultKind of a component of each joint.
template <FaultComponent component>
TraceColumn joint_fault(std::string_view name) {
  TraceColumn result = column<D>(name, "FaultKind, of a simulator", [](const D& d, std::size_t joint) {
    return as_number(fault_of(d.sensors.injected, component, joint));
  });
  result.owner = TraceColumn::Owner::kJoint;
  return result;
}

/// Returns one octal digit per FaultComponent: its FaultKind, or that of the first joint whose component fails.
std::uint64_t fault_code(const InjectedFaults& faults) {
  std::uint64_t code = 0;
  for (auto fault = faults.rbegin(); fault != faults.rend(); ++fault) {
    const auto shift = 3 * static_cast<std::size_t>(fault->component);
    if (fault->kind == FaultKind::kOk || shift >= 3 * kFaultComponents) continue;
    code = (code & ~(std::uint64_t{7} << shift)) | ((static_cast<std::uint64_t>(fault->kind) & 7u) << shift);
  }
  return code;
}

void add_injected(TraceFields& to) {
  static constexpr auto kSize = [](const D*, std::size_t) { return kMaxInjectedFaults; };
  list<D, u8, kMaxInjectedFaults>(to, "injected", "FaultKind of each injected fault, of a simulator; 0: none", kSize,
                                  ELEMENT(sensors.injected[i].kind))
      .shown_as(column<D>("injected", "one octal digit per FaultComponent: its FaultKind, of the first joint",
                          [](const D& d, std::size_t) { return fault_code(d.sensors.injected); }));
  list<D, u8, kMaxInjectedFaults>(to, "injected_component", "FaultComponent of each", kSize,
                                  ELEMENT(sensors.injected[i].component))
      .shown_as(joint_fault<FaultComponent::kEncoder>("injected_encoder"));
  list<D, u8, kMaxInjectedFaults>(to, "injected_index", "joint of each", kSize, ELEMENT(sensors.injected[i].index))
      .shown_as(joint_fault<FaultComponent::kMotor>("injected_motor"));
}

}  // namespace

void add_driver(TraceFields& to) {
  field<D, u64>(to, "driver_instance", "number of the driver's process", MEMBER(sensors.driver_instance));
  field<D, u8>(to, "driver_state", "DriverState", MEMBER(sensors.driver_state)).shown();
  field<D, u64>(to, "faults", "DriverFault bits", MEMBER(sensors.faults)).shown();
  field<D, u64>(to, "valid", "SensorValidity bits", MEMBER(sensors.valid));
  field<D, u64>(to, "joint_count", "", MEMBER(sensors.joint_count));
  field<D, u64>(to, "digital_inputs", "DigitalInput bits", MEMBER(sensors.digital_inputs));
  field<D, u64>(to, "last_gate_cycle", "k-1, or before cycles that were skipped", MEMBER(sensors.gate.cycle));
  field<D, u8>(to, "last_gate_verdict", "GateVerdict, of the last tick", MEMBER(sensors.gate.verdict));
  field<D, u64>(to, "last_gate_reasons", "GateReason bits, of the last tick", MEMBER(sensors.gate.reasons));
  field<D, u64>(to, "last_gate_command_cycle", "of the last tick", MEMBER(sensors.gate.command_cycle));
  field<D, u64>(to, "last_gate_permit_cycle", "of the last tick", MEMBER(sensors.gate.permit_cycle));
  field<D, u64>(to, "last_gate_held", "of the last tick", MEMBER(sensors.gate.held));
  field<D, u64>(to, "last_gate_missed", "of the last tick", MEMBER(sensors.gate.missed));
  field<D, u64>(to, "last_gate_late_permits", "of the last tick", MEMBER(sensors.gate.late_permits));
  field<D, u64>(to, "last_gate_refused", "of the last tick", MEMBER(sensors.gate.refused));
  field<D, f64>(to, "last_gate_contact_schedule", "of the last tick", MEMBER(sensors.gate.contact_schedule));
  field<D, u64>(to, "gate_cycle", "k", MEMBER(gate.cycle));
  field<D, u8>(to, "gate_verdict", "GateVerdict, of tick k", MEMBER(gate.verdict)).shown();
  field<D, u64>(to, "gate_reasons", "GateReason bits", MEMBER(gate.reasons)).shown();
  field<D, u64>(to, "gate_command_cycle", "of the last command found in this run, used or not; 0: none",
                MEMBER(gate.command_cycle))
      .shown();
  field<D, u64>(to, "gate_permit_cycle", "of the permit used", MEMBER(gate.permit_cycle)).shown();
  field<D, u64>(to, "gate_held", "ticks of this run on a held command", MEMBER(gate.held)).shown({"held"});
  field<D, u64>(to, "gate_missed", "ticks of this run braked for want of a command", MEMBER(gate.missed))
      .shown({"missed"});
  field<D, u64>(to, "gate_late_permits", "ticks of this run with a permit older than k-1", MEMBER(gate.late_permits))
      .shown({"late_permits"});
  field<D, u64>(to, "gate_refused", "frames of this run refused", MEMBER(gate.refused)).shown({"refused"});
  field<D, u64>(to, "overruns", "ticks of this run that ended after the next deadline", MEMBER(sensors.overruns))
      .shown()
      .as_timing();
  add_injected(to);
  field<D, u64>(to, "slipped_ns", "ns by which a simulated plant fell behind in this run", MEMBER(sensors.slipped_ns))
      .shown()
      .as_timing();
  field<D, u64>(to, "resumes", "times a simulated plant went on after a pause", MEMBER(sensors.resumes));
  field<D, u64>(to, "held_ns", "ns for which a simulated plant stood", MEMBER(sensors.held_ns));
}

void add_frame_only_gate(TraceFields& to) {
  field<D, f64>(to, "gate_contact_schedule", "of the command that tick k executed", MEMBER(gate.contact_schedule));
}

void add_truth(TraceFields& to) {
  field<D, f32>(to, "truth_position", "m, of base_link from where it was in cycle 0; simulation only",
                MEMBER(truth.pose_world.position))
      .shown({"truth_x", "truth_y", "truth_z"});
  field<D, f32>(to, "truth_orientation", "x, y, z, w", MEMBER(truth.pose_world.orientation))
      .shown_as(column<D>("truth_tilt", "rad, between the verticals of the start pose and of the base",
                          [](const D& d, std::size_t) { return tilt_of(d.truth.pose_world.orientation); }));
  yaw<D>(to, "truth_yaw", MEMBER(truth.pose_world.orientation)).shown();
  field<D, f32>(to, "truth_linear", "m/s, base axes", MEMBER(truth.twist_base.linear))
      .shown({"truth_linear", "truth_lateral", "truth_vertical"});
  field<D, f32>(to, "truth_angular", "rad/s, base axes", MEMBER(truth.twist_base.angular))
      .shown_as(
          column<D>("truth_angular", "rad/s", [](const D& d, std::size_t) { return d.truth.twist_base.angular[2]; }));
  static constexpr auto kSize = [](const D* driver, std::size_t) {
    return driver == nullptr ? 0 : std::min<std::size_t>(driver->truth.contact_count, kMaxContacts);
  };
  field<D, u64>(to, "truth_contact_count", "contacts below, in the order of TraceHeader", MEMBER(truth.contact_count));
  list<D, f32, kMaxContacts>(to, "truth_normal_force", "N, mean over [t_k-1, t_k)", kSize,
                             ELEMENT(truth.normal_force[i]))
      .shown_per_contact();
  list<D, f32, kMaxContacts>(to, "truth_slip", "m/s, speed of the contact patch over ground", kSize,
                             ELEMENT(truth.slip[i]))
      .shown_per_contact();
}

void add_timing(TraceFields& to) {
  field<D, i64>(to, "driver_woke_ns", "ns after the cycle was due; 0 in lockstep", MEMBER(timing.woke_ns))
      .shown()
      .as_timing();
  field<D, i64>(to, "sensors_published_ns", "ns", MEMBER(timing.published_ns)).shown().as_timing();
  field<E, i64>(to, "estimator_woke_ns", "ns", MEMBER(timing.woke_ns)).shown().as_timing();
  field<E, i64>(to, "state_published_ns", "ns", MEMBER(timing.published_ns)).shown().as_timing();
  field<C, i64>(to, "controller_woke_ns", "ns", MEMBER(timing.woke_ns)).shown().as_timing();
  field<C, i64>(to, "command_published_ns", "ns", MEMBER(timing.published_ns)).shown().as_timing();
  field<M, i64>(to, "monitor_woke_ns", "ns", MEMBER(timing.woke_ns)).shown().as_timing();
  field<M, i64>(to, "permit_published_ns", "ns", MEMBER(timing.published_ns)).shown().as_timing();
}

}  // namespace robot_control
