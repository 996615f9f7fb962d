#include "control/wheeled/drive_controller.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "control/wheeled/derived_tuning.h"
#include "control/wheeled/limits/drive_limits.h"
#include "control/wheeled/measured_robot.h"
#include "control/wheeled/wheel_loops/wheel_loop_gains.h"

namespace robot_control {

namespace {

/// Returns the gains of a loop that the drive closes: it has no part of ours, and the speed comes from the encoder
/// alone.
WheelLoopGains no_gains() noexcept {
  return {.kp = 0, .ki = 0, .kd = 0, .model_inertia = std::numeric_limits<double>::infinity()};
}

WheelLoops make_loops(const DriveControllerParameters& parameters, const DriveTrain& described, double period) {
  const DriveTrain robot = measured_robot(described, parameters.feed_forward);
  WheelLoops loops;
  for (const WheelModel& wheel : robot.wheels) {
    const bool ours = robot.wheel_command == WheelCommand::kTorque;
    loops.emplace_back(ours ? wheel_loop_gains(parameters, robot, wheel, period) : no_gains(),
                       tracking_bandwidth(parameters, period), robot.joints[wheel.joint].effort_limit, period);
  }
  return loops;
}

SpeedLeads make_leads(const DriveTrain& robot, double period) {
  const double time = robot.wheel_command == WheelCommand::kVelocity ? robot.wheel_response_time : 0;
  return {robot.wheels.size(), SpeedLead(time, period)};
}

bool is_zero(const PlanarTwist& twist) noexcept {
  return twist.linear == 0 && twist.angular == 0;
}

Twist spatial(const PlanarTwist& twist) noexcept {
  return {.linear = {twist.linear, 0, 0}, .angular = {0, 0, twist.angular}};
}

PlanarTwist scaled(const PlanarTwist& twist, double scale) noexcept {
  return {scale * twist.linear, scale * twist.angular};
}

/// Returns the largest factor m ≥ 0 with |rest + m·inertial| ≤ limit, N·m; infinite if there is none.
double affordable_multiple(double inertial, double rest, double limit) noexcept {
  if (inertial == 0) return std::numeric_limits<double>::infinity();
  return std::max((limit - std::copysign(rest, rest * inertial)) / std::abs(inertial), 0.0);
}

constexpr double kMinAccelerationScale = 0.2;  // lower bound of the scale
constexpr double kUsualLag = 3;                // response times: gains of the drive half as high, and a delay

constexpr std::uint64_t kGateClamps = kGateEffortClamped | kGateRateClamped | kGateSpeedClamped | kGatePositionClamped;
constexpr std::uint64_t kEmergencies = kReasonTimedOut | kReasonRefused | kReasonManySenders | kReasonPermitRamp;
constexpr std::uint64_t kBrakeReasons = kReasonNoPermit | kReasonPermitBrake | kReasonBadSensors | kReasonHolding;

}  // namespace

DriveController::DriveController(const DriveControllerParameters& parameters, const DriveTrain& robot, double period)
    : tuning_(drive_tuning(parameters, robot, period)),
      period_(period),
      joint_count_(robot.joints.size()),
      kinematics_(robot),
      feed_forward_(measured_robot(robot, parameters.feed_forward)),
      ground_friction_(robot),
      watch_(parameters.cmd_vel_timeout, period, kExecutable),
      limiter_(speed_limits(parameters)),
      standstill_(period),
      loops_(make_loops(parameters, robot, period)),
      leads_(make_leads(robot, period)),
      mode_(robot.wheel_command == WheelCommand::kTorque ? JointMode::kEffort : JointMode::kDriveVelocity),
      usual_lag_(kUsualLag * robot.wheel_response_time) {}

void DriveController::enter_run(const VelocityCommand& inbox, bool with_zero) noexcept {
  watch_.enter_run(inbox, with_zero);
  limiter_.restart_from({});
  standstill_.reset();
  held_cycles_ = 0;
  for (WheelLoop& loop : loops_) loop.reset();
  for (SpeedLead& lead : leads_) lead.reset();
  ground_friction_.reset();
  last_cycle_.reset();
  last_angle_.reset();
  periods_ = acceleration_scale_ = 1;
  driving_ = in_control_ = holding_ = false;
  state_cycle_ = permit_cycle_ = 0;
}

void DriveController::tune(const DriveTuning& tuning) noexcept {
  tuning_ = tuning;
  watch_.set_timeout(tuning.cmd_vel_timeout);
  limiter_.set_limits(speed_limits(tuning));
  const auto planned = [&](const PlanarTwist& acceleration) {
    return feed_forward_.efforts(limiter_.value(), acceleration);
  };
  const WheelValues before = planned(limiter_.acceleration()), steady_before = planned({});
  feed_forward_.tune(tuning);
  const WheelValues after = planned(limiter_.acceleration()), steady_after = planned({});
  for (std::size_t i = 0; i < loops_.size(); ++i) {
    FeedForwardDecrease decrease;
    if (driving_ && in_control_) {
      decrease.steady = steady_before[i] - steady_after[i];
      decrease.inertial = before[i] - after[i] - decrease.steady;
    }
    loops_[i].tune(drives_close_loops() ? no_gains() : wheel_loop_gains(tuning.wheels[i]), tuning.tracking_bandwidth,
                   decrease);
  }
}

bool DriveController::usable(const SensorFrame& sensors) const noexcept {
  const std::uint32_t needed = drives_close_loops() ? kValidKinematics : kValidMotion;
  if (sensors.joint_count != joint_count_ || !joints_have(sensors, loops_.size(), needed)) return false;
  if (last_cycle_ && sensors.head.cycle <= *last_cycle_) return false;
  return std::all_of(sensors.joints.begin(), sensors.joints.begin() + static_cast<std::ptrdiff_t>(loops_.size()),
                     [needed](const JointSample& sample) {
                       return std::isfinite(sample.position) && std::isfinite(sample.velocity) &&
                              (needed == kValidKinematics || std::isfinite(sample.effort));
                     });
}

bool DriveController::track(const WheelValues& angle, const SensorFrame& sensors) noexcept {
  const double reach = kFastestWheel * periods_ * period_;
  for (std::size_t i = 0; i < loops_.size(); ++i) {
    if (last_angle_ && std::abs(angle[i] - (*last_angle_)[i]) > reach) return false;
  }
  bool good = true;
  for (std::size_t i = 0; i < loops_.size(); ++i) {
    JointSample sample = sensors.joints[i];
    if (drives_close_loops()) sample.effort = 0;
    loops_[i].measure(sample, periods_, in_control_);
    // Very large finite numbers overflow the tracking loops, which would not recover by themselves.
    good = good && std::isfinite(loops_[i].velocity());
  }
  // Each wheel takes the resolution of the next one, so that all wheels have it within some cycles.
  for (std::size_t i = 0; i < loops_.size(); ++i) loops_[i].assume_encoder_of(loops_[(i + 1) % loops_.size()]);
  return good;
}

bool DriveController::measure(const SensorFrame& sensors) noexcept {
  if (!usable(sensors)) return false;
  periods_ = last_cycle_ ? static_cast<double>(sensors.head.cycle - *last_cycle_) : 1.0;
  last_cycle_ = sensors.head.cycle;
  in_control_ =
      driving_ && sensors.gate.verdict != GateVerdict::kBrake && periods_ <= static_cast<double>(kCommandLife);
  WheelValues angle{};
  for (std::size_t i = 0; i < loops_.size(); ++i) angle[i] = sensors.joints[i].position;
  standstill_.step(angle, sensors.head.cycle);
  if (track(angle, sensors)) {
    last_angle_ = angle;
    return true;
  }
  last_angle_.reset();
  for (WheelLoop& loop : loops_) loop.restart_tracking();
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
  const bool usable_now = state_cycle_ == cycle && (state->base.flags & kStateValid);
  return usable_now ? 0u : std::uint64_t{kReasonNoState};
}

/// Returns the requested twist, limited by the permit.
PlanarTwist DriveController::permitted_twist(const Permit* permit, CommandFrame& out) const noexcept {
  const PlanarTwist requested{out.requested.twist.linear[0], out.requested.twist.angular[2]};
  if ((out.reasons & kReasonPermitRamp) != 0) return {};
  if ((out.reasons & (kReasonNoPermit | kReasonPermitBrake)) != 0)
    return requested;  // The joints are braked in any case.
  if (permit->speed_limit >= kNoSpeedLimit) return requested;
  const double scale = kinematics_.rim_speed_scale(requested, permit->speed_limit);
  if (scale < 1) out.reasons |= kReasonPermitSlow;
  return scaled(requested, scale);
}

bool DriveController::slow() const noexcept {
  return std::all_of(loops_.begin(), loops_.end(),
                     [](const WheelLoop& loop) { return std::abs(loop.velocity()) < kStandstillSpeed; });
}

void DriveController::average_held_efforts(const SensorFrame& sensors) noexcept {
  held_cycles_ = std::min({held_cycles_ + 1, standstill_.cycles() + 1, standstill_.cycles_needed()});
  for (std::size_t i = 0; i < loops_.size(); ++i) {
    held_effort_[i] += (sensors.joints[i].effort - held_effort_[i]) / static_cast<double>(held_cycles_);
  }
}

PlanarTwist DriveController::measured_twist() const noexcept {
  WheelValues measured{};
  for (std::size_t i = 0; i < loops_.size(); ++i) measured[i] = loops_[i].velocity();
  return kinematics_.twist(measured);
}

void DriveController::follow_measured(const SensorFrame& sensors) noexcept {
  if (!drives_close_loops()) average_held_efforts(sensors);
  if (standstill_.standing()) std::ranges::for_each(loops_, &WheelLoop::stand);
  const PlanarTwist twist = measured_twist();
  const double scale = kinematics_.wheel_speed_scale(twist);  // The plan stays within the joints' limits.
  // Strained treads tremble under a brake. A plan that began with that motion would strain them the other way.
  const bool rests = ground_friction_.scrubs() && (standstill_.standing() || slow());
  rest_time_ = 0;
  limiter_.restart_from(rests ? PlanarTwist{} : scaled(twist, scale));
  if (ground_friction_.scrubs()) {
    if (rests) {
      ground_friction_.rest([&](std::size_t wheel) { return held_effort_[wheel]; });
    } else {
      ground_friction_.move(twist, periods_ * period_);
    }
  }
  for (std::size_t i = 0; i < loops_.size(); ++i) {
    loops_[i].reset_to_measured();
    leads_[i].reset();
    if (standstill_.standing() && !drives_close_loops())
      loops_[i].preload_integrator(held_effort_[i] - ground_friction_.effort(i));
  }
}

double DriveController::affordable_acceleration_scale(const PlanarTwist& limited,
                                                      const WheelValues& feed_forward) const noexcept {
  if (acceleration_scale_ == 1 && std::ranges::none_of(loops_, &WheelLoop::saturated)) return 1;
  const WheelValues unaccelerated = feed_forward_.efforts(limited, {});
  double multiple = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < loops_.size(); ++i) {
    const double inertial = feed_forward[i] - unaccelerated[i];
    multiple = std::min(
        multiple, affordable_multiple(inertial, loops_[i].unclamped_effort() - inertial, loops_[i].effort_limit()));
  }
  if (std::isinf(multiple)) return 1;
  return std::clamp(multiple * limiter_.used_acceleration_scale(), kMinAccelerationScale, 1.0);
}

double DriveController::followable_acceleration_scale(const WheelValues& velocity,
                                                      const WheelValues& acceleration) const noexcept {
  double scale = 1;
  for (std::size_t i = 0; i < loops_.size(); ++i) {
    if (acceleration[i] == 0) continue;
    const double usual = usual_lag_ * std::abs(acceleration[i]) / limiter_.used_acceleration_scale();
    const double lag = std::copysign(1.0, acceleration[i]) * (velocity[i] - loops_[i].velocity());
    scale = std::min(scale, 2 - lag / usual);
  }
  return std::max(scale, kMinAccelerationScale);
}

WheelValues DriveController::planned_efforts(const PlanarTwist& twist, const PlanarTwist& acceleration) noexcept {
  WheelValues efforts = in_control_ ? feed_forward_.efforts(twist, acceleration) : WheelValues{};
  if (!ground_friction_.scrubs() || drives_close_loops()) return efforts;
  if (in_control_) {
    learn_ground_friction();
    ground_friction_.move(twist, periods_ * period_);
    if (ground_friction_.searches() && twist.angular != 0) search_ground_friction(twist);
  }
  for (std::size_t i = 0; i < loops_.size(); ++i) efforts[i] += ground_friction_.effort(i);
  return efforts;
}

void DriveController::search_ground_friction(const PlanarTwist& twist) noexcept {
  const PlanarTwist measured = measured_twist();
  const WheelValues joints = feed_forward_.efforts(twist, {});
  const WheelValues momenta = feed_forward_.efforts({}, measured);
  ground_friction_.search(
      {.part = measured.angular / twist.angular,
       .integral = ground_friction_.along([&](std::size_t i) { return loops_[i].integral(); }),
       .effort = ground_friction_.along([&](std::size_t i) { return loops_[i].unclamped_effort() - joints[i]; }),
       .momentum = ground_friction_.along([&](std::size_t i) { return momenta[i]; })},
      periods_ * period_);
}

void DriveController::learn_ground_friction() noexcept {
  const double more = ground_friction_.learn([&](std::size_t wheel) { return loops_[wheel].integral(); });
  if (more == 0) return;
  for (std::size_t i = 0; i < loops_.size(); ++i) loops_[i].move_to_feed_forward(more * ground_friction_.strain(i));
}

double DriveController::faster_rim(const PlanarTwist& twist) const noexcept {
  const SidePair rims = kinematics_.rim_speeds(twist);
  return std::max(std::abs(rims.left), std::abs(rims.right));
}

bool DriveController::leaves_stop(bool stops, bool planned_rest) noexcept {
  const bool begins = !stops || (planned_rest && rest_time_ == 0);
  rest_time_ = planned_rest ? rest_time_ + periods_ * period_ : 0;
  if (begins || (drives_close_loops() && !planned_rest)) std::ranges::for_each(loops_, &WheelLoop::expect_plan);
  WheelValues off{};
  for (std::size_t i = 0; i < loops_.size(); ++i) off[i] = loops_[i].off_plan();
  if (!stops) stop_way_ = std::max(kStopWay, kStopTime * faster_rim(limiter_.value()));
  return rest_time_ > kRestTime || faster_rim(kinematics_.twist(off)) > (planned_rest ? kRestWay : stop_way_);
}

void DriveController::drive(const PlanarTwist& requested, const SensorFrame& sensors, CommandFrame& out) noexcept {
  const bool stops = is_zero(requested);
  bool at_rest = false;
  if (in_control_) {
    held_cycles_ = 0;
    const bool planned_rest = is_zero(limiter_.value()) && std::ranges::all_of(leads_, &SpeedLead::ended);
    at_rest = leaves_stop(stops, planned_rest) || (planned_rest && standstill_.standing());
  } else {
    follow_measured(sensors);
    at_rest = holding_ || standstill_.standing() || slow();
  }
  holding_ = stops && at_rest;
  if (holding_) out.reasons |= kReasonHolding;
  driving_ = (out.reasons & kBrakeReasons) == 0;
  if (!driving_) return;

  if (in_control_) {
    const PlanarTwist goal = scaled(requested, kinematics_.wheel_speed_scale(requested));
    if (goal.linear != requested.linear || goal.angular != requested.angular || acceleration_scale_ < 1)
      out.reasons |= kReasonSaturated;
    limiter_.step(goal, periods_ * period_, (out.reasons & kEmergencies) != 0, acceleration_scale_);
    out.reasons |= limiter_.reasons();
  }
  // A target that changed during a ramp may lead past the wheels' limits.
  const double scale = kinematics_.wheel_speed_scale(limiter_.value());
  if (scale < 1) out.reasons |= kReasonSaturated;
  const PlanarTwist limited = scaled(limiter_.value(), scale);
  const PlanarTwist rate = scaled(limiter_.acceleration(), scale);
  const WheelValues velocity = kinematics_.joint_speeds(limited);
  const WheelValues acceleration = kinematics_.joint_speeds(rate);
  const WheelValues feed_forward = planned_efforts(limited, rate);
  const bool clamped = in_control_ && (sensors.gate.reasons & kGateClamps) != 0;
  if (clamped) out.reasons |= kReasonSaturated;
  for (std::size_t i = 0; i < loops_.size(); ++i) {
    const double effort = loops_[i].step({velocity[i], acceleration[i], feed_forward[i]}, periods_, clamped);
    const bool alone = !has(sensors.joints[i], kTakesEffort);
    const double ordered = alone ? leads_[i].step(velocity[i], acceleration[i], periods_) : velocity[i];
    out.joints[i] = {.mode = mode_, .velocity = ordered, .effort = effort};
    if (loops_[i].saturated()) out.reasons |= kReasonSaturated;
  }
  if (!in_control_) {
    acceleration_scale_ = 1;
  } else if (drives_close_loops()) {
    acceleration_scale_ = followable_acceleration_scale(velocity, acceleration);
  } else {
    acceleration_scale_ = affordable_acceleration_scale(limited, feed_forward);
  }
  out.twist_limited = spatial(limited);
}

void DriveController::step(const ControlInput& input, CommandFrame& out) noexcept {
  const SensorFrame& sensors = *input.sensors;
  const std::uint64_t cycle = sensors.head.cycle;
  out.joint_count = joint_count_;
  std::fill_n(out.joints.begin(), joint_count_, JointCommand{});
  out.wheeled = {};
  out.twist_limited = {};

  out.requested = watch_.step(input.request, cycle);
  out.reasons = watch_.reasons() | permit_reasons(input.permit, cycle) | state_reasons(input.state, cycle);
  if (input.permit != nullptr) permit_cycle_ = input.permit->head.cycle;

  if (measure(sensors)) {
    drive(permitted_twist(input.permit, out), sensors, out);
    for (std::size_t i = 0; i < loops_.size(); ++i) out.wheeled.velocity[i] = loops_[i].velocity();
  } else {
    out.reasons |= kReasonBadSensors;
    driving_ = false;
  }

  out.state_cycle = state_cycle_;
  out.permit_cycle = permit_cycle_;
  watch_.report(cycle, out);
}

}  // namespace robot_control
