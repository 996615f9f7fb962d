#pragma once
/// A second robot kind: a pendulum on a base. It shows that plant, bus, gate, monitor, log and replay know no wheels.
///
/// One driven joint turns a pole about the y axis; at angle 0 the pole hangs. `angular.z` of a request is the speed of
/// the joint in rad/s, at most kMaxSpeed. The stop action moves the pole down within kDownTime
/// and brakes it after kBrakeTime.

#include <algorithm>
#include <cmath>
#include <memory>

#include "configuration/parameters.h"
#include "control/common/command_watch.h"
#include "robots/robot.h"
#include "safety/monitor.h"

namespace robot_control {

inline constexpr double kMaxSpeed = 2.0;    // rad/s
inline constexpr double kDownTime = 0.4;    // s
inline constexpr double kBrakeTime = 0.48;  // s
inline constexpr double kGain = 10;         // N·m·s/rad, of the velocity loop
inline constexpr double kDamping = 1.0;     // N·m·s/rad, of the stop action
inline constexpr double kStiffness = 40;    // N·m/rad, of the stop action
inline constexpr double kWindow = 0.01;     // rad, within which a joint stands

inline constexpr const char* kPendulumUrdf = R"(<robot name="pendulum">
  <link name="base">
    <inertial><origin xyz="0 0 0.2"/><mass value="10"/><inertia ixx="0.3" iyy="0.3" izz="0.3" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><origin xyz="0 0 0.1"/><geometry><box size="0.5 0.5 0.2"/></geometry></collision>
  </link>
  <link name="pole">
    <inertial><origin xyz="0 0 -0.2"/><mass value="0.5"/><inertia ixx="0.003" iyy="0.003" izz="0.0002" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><origin xyz="0 0 -0.2"/><geometry><cylinder radius="0.01" length="0.4"/></geometry></collision>
  </link>
  <joint name="pole_joint" type="revolute">
    <parent link="base"/><child link="pole"/><origin xyz="0.3 0 0.7"/><axis xyz="0 1 0"/>
    <limit lower="-2.5" upper="2.5" effort="10" velocity="5"/><dynamics damping="0.01"/>
  </joint>
</robot>)";

/// The base stands still; the joint moves as measured.
struct PendulumEstimator {
  std::uint64_t cycles = 0;

  void enter_run() noexcept { cycles = 0; }
  void resume(const StateFrame& last) noexcept { cycles = static_cast<std::uint64_t>(last.base.distance); }
  void set_pose(const Vector3&) noexcept {}
  void step(const SensorFrame& sensors, StateFrame& out) noexcept {
    out = {};
    ++cycles;
    out.base.flags = kStateValid;
    out.base.distance = static_cast<double>(cycles);  // a state that a replay must restore
    out.joint_velocity[0] = sensors.joints[0].velocity;
  }
};

struct PendulumController {
  static constexpr std::uint64_t kExecutable = kPartAngularZ;
  explicit PendulumController(double period) : watch(0.5, period, kExecutable) {}
  CommandWatch watch;

  void enter_run(const VelocityCommand& inbox, bool with_zero) noexcept { watch.enter_run(inbox, with_zero); }
  void step(const ControlInput& input, CommandFrame& out) noexcept {
    const std::uint64_t cycle = input.sensors->head.cycle;
    out = {};
    out.joint_count = 1;
    out.requested = watch.step(input.request, cycle);
    out.reasons = watch.reasons();
    watch.report(cycle, out);
    if (input.state != nullptr) out.state_cycle = cycle;
    if (input.permit == nullptr || input.permit->action == PermitAction::kBrake) {
      out.reasons |= input.permit == nullptr ? kReasonNoPermit : kReasonPermitBrake;
      return;
    }
    const bool drives = input.permit->action == PermitAction::kDrive;
    const double speed = drives ? std::clamp(out.requested.twist.angular[2], -kMaxSpeed, kMaxSpeed) : 0.0;
    out.twist_limited.angular[2] = speed;
    out.joints[0] = {.mode = JointMode::kVelocity, .velocity = speed, .damping = kGain};
  }
};

/// The joint keeps away from its end stops; and what it shows of standstill.
class PendulumConditions {
 public:
  PendulumConditions(const SafetyParameters&, const MachineModel& machine, double period)
      : limit_(machine.joints[0].range->upper - 0.5), period_(period) {}
  static std::size_t driven_joints(const MachineModel& machine) noexcept { return machine.joints.size(); }

  void enter_run() noexcept { still_ = 0; }
  void step(const MonitorInput& input, std::uint64_t elapsed, double /*speed_limit*/, ActiveCauses& out) noexcept {
    const JointSample& joint = input.sensors->joints[0];
    const bool inside = has_position(joint) && std::abs(joint.position - anchor_) < kWindow;
    still_ = inside ? still_ + static_cast<double>(elapsed) * period_ : 0;
    if (!inside) anchor_ = joint.position;
    moving_ = !inside;
    if (std::abs(joint.position) > limit_)
      out.add(kCauseWheelSpeed, Reaction::kBrake, beyond(0, std::abs(joint.position), limit_));
  }
  bool moving() const noexcept { return moving_; }
  bool standing() const noexcept { return still_ > 0.1; }
  bool sliding() const noexcept { return false; }

 private:
  double limit_, period_;
  double anchor_ = 0;  // rad
  double still_ = 0;   // s
  bool moving_ = false;
};

class Pendulum final : public Robot {
 public:
  explicit Pendulum(const Parameters& parameters)
      : parameters_(parameters), machine_(read_machine({.text = kPendulumUrdf, .source = "pendulum"}, {})) {
    machine_.joints[0].role = JointRole::kDriven;
  }

  const MachineModel& machine() const noexcept override { return machine_; }
  std::string_view kind() const noexcept override { return "pendulum"; }
  void require_drivable() const override {}
  std::uint64_t executable() const noexcept override { return PendulumController::kExecutable; }
  std::unique_ptr<EstimatorLaw> make_estimator() const override {
    return std::make_unique<EstimatorOf<PendulumEstimator>>();
  }
  std::unique_ptr<ControllerLaw> make_controller() const override {
    return std::make_unique<ControllerOf<PendulumController>>(parameters_.loop.period());
  }
  std::unique_ptr<MonitorLaw> make_monitor() const override {
    return std::make_unique<MonitorOf<Monitor<PendulumConditions>>>(parameters_.safety, machine_,
                                                                    parameters_.loop.period());
  }
  MachineNeeds needs() const override {
    return {.modes = {JointMode::kBrake, JointMode::kVelocity}, .inputs = {MachineInput::kJointMotion}};
  }
  GateParameters gate() const override {
    return {.profiles = {{{.kind = StopKind::kMove,
                           .damping = kDamping,
                           .stiffness = kStiffness,
                           .time = kDownTime,
                           .brake_after = kBrakeTime}}}};
  }

 private:
  Parameters parameters_;
  MachineModel machine_;
};

}  // namespace robot_control
