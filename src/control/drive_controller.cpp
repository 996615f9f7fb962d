#include "control/drive_controller.h"

#include <cmath>

#include "control/control_problems.h"

namespace robot_control {

namespace {

WheelLoop make_loop(const DriveControllerParameters& parameters, const RobotModel& robot, const WheelModel& wheel,
                    double period) {
  return {wheel_loop_gains(parameters, wheel), parameters.tracking_bandwidth, robot.joints[wheel.joint].effort_limit,
          period};
}

bool is_zero(const PlanarTwist& twist) noexcept {
  return twist.linear == 0 && twist.angular == 0;
}

Twist spatial(const PlanarTwist& twist) noexcept {
  return {.linear = {twist.linear, 0, 0}, .angular = {0, 0, twist.angular}};
}

JointCommand effort_command(double velocity, double effort) noexcept {
  return {.mode = JointMode::kEffort, .velocity = velocity, .effort = effort};
}

constexpr std::uint64_t kBrakeReasons = kReasonNoPermit | kReasonPermitBrake | kReasonBadSensors | kReasonHolding;

}  // namespace

DriveController::DriveController(const DriveControllerParameters& parameters, const RobotModel& robot, double period)
    : period_(period),
      joint_count_(robot.joints.size()),
      left_joint_(robot.left.joint),
      right_joint_(robot.right.joint),
      kinematics_(robot),
      feed_forward_(robot),
      watch_(parameters.cmd_vel_timeout, period),
      limiter_({parameters.max_linear_speed, parameters.max_angular_speed, parameters.max_linear_acceleration,
                parameters.max_angular_acceleration}),
      standstill_(period),
      left_(make_loop(parameters, robot, robot.left, period)),
      right_(make_loop(parameters, robot, robot.right, period)) {}

void DriveController::reset(std::uint64_t request_count) noexcept {
  watch_.reset(request_count);
  limiter_.seed({});
  standstill_.reset();
  left_.reset();
  right_.reset();
  last_cycle_.reset();
  last_angle_.reset();
  periods_ = 1;
  driving_ = followed_ = false;
  state_cycle_ = permit_cycle_ = 0;
}

bool DriveController::usable(const SensorFrame& sensors) const noexcept {
  if (!(sensors.valid & kValidJoints) || sensors.joint_count != joint_count_) return false;
  if (last_cycle_ && sensors.head.cycle <= *last_cycle_) return false;
  const auto finite = [&](std::size_t joint) {
    const JointSample& sample = sensors.joints[joint];
    return std::isfinite(sample.position) && std::isfinite(sample.velocity) && std::isfinite(sample.effort);
  };
  return finite(left_joint_) && finite(right_joint_);
}

bool DriveController::track(const WheelPair& angle, const SensorFrame& sensors) noexcept {
  const double reach = kFastestWheel * periods_ * period_;
  if (last_angle_ &&
      (std::abs(angle.left - last_angle_->left) > reach || std::abs(angle.right - last_angle_->right) > reach)) {
    return false;
  }
  left_.measure(sensors.joints[left_joint_], periods_, followed_);
  right_.measure(sensors.joints[right_joint_], periods_, followed_);
  // Absurd but finite numbers overflow the tracking loops; they would never recover by themselves.
  return std::isfinite(left_.velocity()) && std::isfinite(right_.velocity());
}

bool DriveController::measure(const SensorFrame& sensors) noexcept {
  if (!usable(sensors)) return false;
  periods_ = last_cycle_ ? static_cast<double>(sensors.head.cycle - *last_cycle_) : 1.0;
  last_cycle_ = sensors.head.cycle;
  followed_ = driving_ && sensors.gate.verdict != GateVerdict::kBrake && periods_ <= static_cast<double>(kCommandLife);
  const WheelPair angle{sensors.joints[left_joint_].position, sensors.joints[right_joint_].position};
  standstill_.step(angle, sensors.head.cycle);
  if (track(angle, sensors)) {
    last_angle_ = angle;
    return true;
  }
  last_angle_.reset();
  left_.lose_track();
  right_.lose_track();
  return false;
}

std::uint64_t DriveController::permit_reasons(const Permit* permit, std::uint64_t cycle) const noexcept {
  if (permit == nullptr) return kReasonNoPermit;
  if (permit->action == PermitAction::kDrive) return 0;
  if (permit->action == PermitAction::kRamp && cycle <= permit->ramp_until) return kReasonPermitRamp;
  return kReasonPermitBrake;
}

std::uint64_t DriveController::state_reasons(const StateFrame* state, std::uint64_t cycle) noexcept {
  if (state == nullptr) return kReasonNoState;
  state_cycle_ = state->head.cycle;
  const bool usable_now = state_cycle_ == cycle && (state->flags & kStateValid);
  return usable_now ? 0u : std::uint64_t{kReasonNoState};
}

bool DriveController::slow() const noexcept {
  return std::abs(left_.velocity()) < kStandstillSpeed && std::abs(right_.velocity()) < kStandstillSpeed;
}

void DriveController::follow_measured(const SensorFrame& sensors) noexcept {
  const WheelPair measured{left_.velocity(), right_.velocity()};
  limiter_.seed(kinematics_.twist(measured));
  left_.resume();
  right_.resume();
  if (standstill_.standing() || slow()) {
    left_.carry(sensors.joints[left_joint_].effort);
    right_.carry(sensors.joints[right_joint_].effort);
  }
}

void DriveController::drive(const PlanarTwist& wish, const SensorFrame& sensors, CommandFrame& out) noexcept {
  if (!followed_) follow_measured(sensors);
  const bool at_rest =
      followed_ ? is_zero(limiter_.value()) && standstill_.standing() : standstill_.standing() || slow();
  if (is_zero(wish) && at_rest) out.reasons |= kReasonHolding;
  driving_ = (out.reasons & kBrakeReasons) == 0;
  if (!driving_) return;

  if (followed_) {
    const double scale = kinematics_.wheel_speed_scale(wish);
    if (scale < 1) out.reasons |= kReasonSaturated;
    limiter_.step({scale * wish.linear, scale * wish.angular}, periods_ * period_);
    out.reasons |= limiter_.reasons();
  }
  const PlanarTwist& limited = limiter_.value();
  const WheelPair velocity = kinematics_.joint_speeds(limited);
  const WheelPair acceleration = kinematics_.joint_speeds(limiter_.acceleration());
  const WheelPair feed_forward = followed_ ? feed_forward_.efforts(limited, limiter_.acceleration()) : WheelPair{};
  const double left = left_.step({velocity.left, acceleration.left, feed_forward.left}, periods_);
  const double right = right_.step({velocity.right, acceleration.right, feed_forward.right}, periods_);
  if (left_.saturated() || right_.saturated()) out.reasons |= kReasonSaturated;
  out.joints[left_joint_] = effort_command(velocity.left, left);
  out.joints[right_joint_] = effort_command(velocity.right, right);
  out.twist_limited = spatial(limited);
}

void DriveController::step(const ControlInput& input, CommandFrame& out) noexcept {
  const SensorFrame& sensors = *input.sensors;
  const std::uint64_t cycle = sensors.head.cycle;
  out.joint_count = joint_count_;
  out.joints.fill({});
  out.velocity_measured.fill(0);
  out.twist_limited = {};

  out.twist_requested = watch_.step(input.request, cycle);
  out.reasons = watch_.reasons() | permit_reasons(input.permit, cycle) | state_reasons(input.state, cycle);
  if (input.permit != nullptr) permit_cycle_ = input.permit->head.cycle;

  if (measure(sensors)) {
    PlanarTwist wish{out.twist_requested.linear[0], out.twist_requested.angular[2]};
    if (out.reasons & kReasonPermitRamp) wish = {};
    drive(wish, sensors, out);
    out.velocity_measured[left_joint_] = left_.velocity();
    out.velocity_measured[right_joint_] = right_.velocity();
  } else {
    out.reasons |= kReasonBadSensors;
    driving_ = false;
  }

  out.state_cycle = state_cycle_;
  out.permit_cycle = permit_cycle_;
  out.request_cycle = watch_.request_cycle();
  out.requests_received = watch_.received();
  out.requests_refused = watch_.refused();
  out.timeouts = watch_.timeouts();
}

}  // namespace robot_control
