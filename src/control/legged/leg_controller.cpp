#include "control/legged/leg_controller.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "control/legged/posture/ground_slope.h"
#include "control/legged/stand/body_bounds.h"
#include "control/legged/walk/own_gaits.h"
#include "control/legged/walk/walking_speed.h"

namespace robot_control {
namespace {

constexpr double kMinLift = 0.25;  // of the lift, the lowest height of a foot in the air
constexpr double kSetDown = 0.1;   // m/s, of a foot that lies above the ground
constexpr double kShift = 0.6;     // of the way from the middle to the centroid of three feet
constexpr double kMinTime = 0.1;   // s, of gathering
constexpr std::uint64_t kNoWish =
    kReasonNoCommand | kReasonTimedOut | kReasonRefused | kReasonManySenders | kReasonNotLying;

using Map = Eigen::Map<const Eigen::Vector3d>;

double smooth(double part) noexcept {
  const double s = std::clamp(part, 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

void approach(double& value, double target, double step) noexcept {
  value += std::clamp(target - value, -step, step);
}

/// Returns the leg whose foot is requested in the air, or kLegs.
std::uint64_t lifted_by(const Mode& mode) noexcept {
  return mode.kind == ModeKind::kLift ? std::min<std::uint64_t>(mode.index, kLegs) : kLegs;
}

}  // namespace

LegController::LegController(const LegModel& robot, const LegControllerParameters& parameters, double period)
    : period_(period),
      legs_(robot.legs),
      dynamics_(robot),
      tuning_(leg_tuning(robot)),
      ground_(robot.belly),
      nominal_(nominal_height(robot)),
      lying_pitch_(robot.lying_pitch),
      body_motion_(body_bounds(robot)),
      lie_down_after_(parameters.lie_down_after),
      limiter_(twist_limits(parameters)),
      walker_(robot, all_gaits(parameters.gaits), parameters.friction, period),
      leg_use_(robot, nominal_stance(robot)),
      state_(CommandWatch(parameters.request_timeout, period, kExecutable)) {
  const NominalStance stance = nominal_stance(robot);
  fastest_ = walking_speeds(robot, stance, walker_.gaits());
  for (const Eigen::Vector3d& foot : stance.feet)
    foot_distance_ = std::max(foot_distance_, (foot - stance.equations.centre_of_gravity).head<2>().norm());
  const std::array<JointBounds, kLegsJoints> bounds = joint_bounds(robot);
  for (std::size_t i = 0; i < kLegsJoints; ++i) {
    joint_ranges_[i] = bounds[i].range;
    joint_motion_[i] = bounds[i].motion;
    joint_steps_[i] = robot.joints[i].velocity_limit * period;
  }
}

void LegController::enter_run(const VelocityCommand& inbox, bool with_zero) noexcept {
  CommandWatch watch = state_.watch;
  watch.enter_run(inbox, with_zero);
  state_ = State(watch);
}

void LegController::step(const ControlInput& input, CommandFrame& out) noexcept {
  const SensorFrame& sensors = *input.sensors;
  const std::uint64_t cycle = sensors.head.cycle;
  out = {};
  out.joint_count = kLegsJoints;
  out.requested = state_.watch.step(input.request, cycle);
  out.reasons = state_.watch.reasons();
  state_.watch.report(cycle, out);
  if (input.state != nullptr) out.state_cycle = input.state->head.cycle;
  if (input.permit != nullptr) out.permit_cycle = input.permit->head.cycle;
  const bool measured = joints_have(sensors, kLegsJoints, kValidPosition) &&
                        std::all_of(sensors.joints.begin(), sensors.joints.begin() + kLegsJoints,
                                    [](const JointSample& joint) { return std::isfinite(joint.position); });
  const bool braked = input.permit == nullptr || input.permit->action == PermitAction::kBrake;
  if (input.permit == nullptr) out.reasons |= kReasonNoPermit;
  if (input.permit != nullptr && braked) out.reasons |= kReasonPermitBrake;
  if (!measured) out.reasons |= kReasonBadSensors;
  if (input.permit != nullptr && braked) state_ = State(state_.watch);
  if (braked || !measured) return pause();
  Request request = out.requested;
  if (input.permit->action == PermitAction::kRamp) {
    out.reasons |= kReasonPermitRamp;
    request = {.twist = {}, .posture = {}, .mode = {ModeKind::kLie}};
  }
  if (state_.phase != LegPhase::kWalking) state_.gap = 0;
  state_.pace = std::min(1.0, input.permit->speed_limit / body_motion_[kX].speed);
  const bool of_joints = request.mode.kind == ModeKind::kJoints;
  const bool lifts = lifted_by(request.mode) != kLegs;
  const bool of_standing = !of_joints && ((parts_of(request) & kPose) != 0 || lifts);
  const bool stands = state_.phase == LegPhase::kStanding || (state_.phase == LegPhase::kWalking && !lifts);
  if (of_standing && !stands && !walks(request)) out.reasons |= kReasonNotStanding;
  if (!known(request.mode)) out.reasons |= kReasonPartIgnored;
  const bool lies = state_.phase == LegPhase::kLying || state_.phase == LegPhase::kJoints;
  if (of_joints && !lies) out.reasons |= kReasonNotLying;
  const std::array<double, kLegsJoints> before = state_.angles;
  const bool began = advance(request, input, out.reasons);
  if (state_.phase == LegPhase::kWalking) return walk(input, request, out);
  report(out);
  if (state_.phase == LegPhase::kLying) {
    out.reasons |= kReasonHolding;
    return;
  }
  std::array<double, kLegsJoints> rates{};
  for (std::size_t i = 0; i < kLegsJoints && !began; ++i) rates[i] = (state_.angles[i] - before[i]) / period_;
  if (state_.phase != LegPhase::kGathering) roll_feet(rates);
  write(rates, out);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    out.twist_limited.linear[axis] = state_.body[axis].speed;
    out.twist_limited.angular[axis] = state_.body[kRoll + axis].speed;
  }
}

/// Returns true if the robot has the foot or the gait that the mode names.
bool LegController::known(const Mode& mode) const noexcept {
  if (mode.kind == ModeKind::kGait) return mode.index != kStandGait && mode.index < fastest_.size();
  return mode.kind < ModeKind::kGait && (mode.kind != ModeKind::kLift || mode.index < kLegs);
}

/// All joints brake in this cycle.
void LegController::pause() noexcept {
  if (++state_.gap > kMaxGap) state_ = State(state_.watch);
}

/// Returns true if the joints begin to move in this cycle.
bool LegController::advance(const Request& request, const ControlInput& input, std::uint64_t& reasons) noexcept {
  state_.elapsed += period_;
  const ModeKind wanted = request.mode.kind;
  const bool down = wanted == ModeKind::kLie;
  const bool up = wanted == ModeKind::kStand || walks(request);
  switch (state_.phase) {
    case LegPhase::kLying:
      if (up ? state_.steep != 0 && !stands_up_here(input, reasons) : wanted != ModeKind::kJoints) return false;
      for (std::size_t i = 0; i < kLegsJoints; ++i)
        state_.from[i] = state_.angles[i] = input.sensors->joints[i].position;
      state_.joints.begin(state_.from);
      enter(up ? LegPhase::kGathering : LegPhase::kJoints, 0);
      return true;
    case LegPhase::kJoints:
      move_joints(request, reasons);
      state_.from = state_.angles;
      if (up) enter(LegPhase::kGathering, 0);
      if (down) enter(LegPhase::kLying, 0);
      return false;
    case LegPhase::kGathering:
      gather(input, reasons);
      if (down) state_.phase = LegPhase::kLying;
      return false;
    case LegPhase::kRising:
      rise(state_.elapsed, reasons);
      if (state_.elapsed >= tuning_.rise_time) {
        enter(LegPhase::kStanding, 0);
        state_.margin = margin();
      }
      if (down) {
        const double left = tuning_.rise_time - state_.elapsed;
        enter(LegPhase::kLowering, left);
        state_.sinks = 1;
      }
      return false;
    case LegPhase::kStanding:
      stand(request, reasons);
      state_.idle = parts_of(request) == 0 ? state_.idle + period_ : 0;
      if (walks(request) && state_.lifted == kLegs) begin_walk(input);
      if (down || state_.lies_next != 0 || (lie_down_after_ > 0 && state_.idle >= lie_down_after_))
        enter(LegPhase::kLowering, 0);
      return false;
    case LegPhase::kWalking:
      return false;
    case LegPhase::kLowering:
      lower(reasons);
      if (up && state_.phase == LegPhase::kLowering)
        enter(state_.sinks != 0 ? LegPhase::kRising : LegPhase::kStanding, tuning_.rise_time - state_.elapsed);
      return false;
  }
  return false;
}

void LegController::report(CommandFrame& out) const noexcept {
  out.legged.phase = state_.phase;
  out.legged.lifted = state_.phase >= LegPhase::kStanding && state_.lifted != kLegs ? state_.lifted + 1 : 0;
  if (state_.phase < LegPhase::kRising || state_.phase > LegPhase::kLowering) return;
  for (std::size_t leg = 0; leg < kLegs; ++leg) out.legged.stance[leg] = state_.share[leg] > 0 ? 0.5 : 0;
  if (state_.phase != LegPhase::kStanding) return;
  const std::array<double, 3> nominal{state_.home[0], state_.home[1], nominal_};
  for (std::size_t i = 0; i < state_.body.size(); ++i)
    out.legged.body[i] = state_.body[i].value - (i < kRoll ? nominal[i] : 0);
}

void LegController::enter(LegPhase phase, double elapsed) noexcept {
  state_.phase = phase;
  state_.elapsed = std::max(0.0, elapsed);
  state_.sinks = 0;
  state_.idle = 0;
  state_.lies_next = state_.steep = 0;
}

void LegController::move_joints(const Request& request, std::uint64_t& reasons) noexcept {
  if (request.mode.kind == ModeKind::kJoints) {
    std::array<double, kLegsJoints> target{};
    for (std::size_t i = 0; i < kLegsJoints; ++i) {
      target[i] = std::clamp(request.joints[i], joint_ranges_[i].lower, joint_ranges_[i].upper);
      if (target[i] != request.joints[i]) reasons |= kReasonOutOfReach;
    }
    const std::uint64_t requested = state_.watch.request_cycle();
    state_.joints.follow(target, state_.joints_requested != requested, joint_motion_, period_);
    state_.joints_requested = requested;
  } else {
    state_.joints.stop(joint_motion_, period_);
  }
  for (std::size_t i = 0; i < kLegsJoints; ++i) state_.angles[i] = state_.joints.axes[i].value;
}

/// Measures the slope of the ground below the lying posture. Returns false where it is too steep to stand up.
bool LegController::stands_up_here(const ControlInput& input, std::uint64_t& reasons) noexcept {
  state_.up = {0, 0, 1};
  if (input.state == nullptr || (input.state->base.flags & kStateValid) == 0) return true;
  const Eigen::Vector3d up = vertical_over_ground(input.state->base.attitude, lying_pitch_);
  const bool steep = up.z() < std::cos(kMaxSlope);
  if (steep) reasons |= kReasonTooSteep;
  if (up.z() < std::cos(kLevelSlope)) state_.up = {up.x(), up.y(), up.z()};
  return !steep;
}

void LegController::gather(const ControlInput& input, std::uint64_t& reasons) noexcept {
  double time = kMinTime;
  for (std::size_t i = 0; i < kLegsJoints; ++i)  // the smooth way is 1.5 times as fast in its middle
    time = std::max(time, 1.5 * std::abs(lying(i) - state_.from[i]) / joint_motion_[i].speed);
  const double part = smooth(state_.elapsed / time);
  for (std::size_t i = 0; i < kLegsJoints; ++i) state_.angles[i] = state_.from[i] + part * (lying(i) - state_.from[i]);
  if (state_.elapsed < time) return;
  const bool stands_up = stands_up_here(input, reasons);
  enter(stands_up ? LegPhase::kRising : LegPhase::kLying, 0);
  state_.steep = stands_up ? 0 : 1;
  state_.body = {};
  state_.held = {};
  state_.follows = 0;
  state_.share = {};
  state_.lifted = kLegs;
  for (std::size_t leg = 0; leg < kLegs; ++leg)
    Eigen::Map<Eigen::Vector3d>(state_.places[leg].data()) = legs_[leg].kinematics.position(legs_[leg].lying);
}

/// Puts the body where it is `elapsed` seconds after it began to rise.
void LegController::rise(double elapsed, std::uint64_t& reasons) noexcept {
  if (state_.phase == LegPhase::kRising) {
    const Eigen::Vector2d middle = above_support();
    state_.home = {middle.x(), middle.y()};
  }
  const double part = smooth(elapsed / tuning_.rise_time);
  const double standing[3] = {state_.home[0], state_.home[1], nominal_};
  for (std::size_t i = 0; i < 3; ++i) {
    const double before = state_.body[i].value;
    state_.body[i].value = part * standing[i];
    state_.body[i].speed = (state_.body[i].value - before) / period_;
  }
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    approach(state_.places[leg][2], ground_ + legs_[leg].foot_radius, kSetDown * period_);
    state_.share[leg] = std::clamp(elapsed / kLoadTime, 0.0, 1.0);
  }
  if (!set_angles()) reasons |= kReasonOutOfReach;
}

void LegController::stand(const Request& request, std::uint64_t& reasons) noexcept {
  const std::uint64_t wanted = lifted_by(request.mode);
  if (state_.lifted == kLegs && wanted != kLegs) {
    state_.lifted = wanted;
    state_.foot = {};
    state_.foot_target = {};
  }
  if (state_.lifted == kLegs && !walks(request)) {
    choose_pose(request, reasons);
  } else {
    state_.held = {};
    state_.follows = 0;
  }
  const Eigen::Vector2d place = standing_place();
  Pose target = state_.held;
  target[kX] += place.x();
  target[kY] += place.y();
  target[kZ] += nominal_;
  const bool reached = move(target, reasons);
  if (state_.lifted != kLegs) move_foot(request, state_.lifted == wanted, reached, reasons);
}

void LegController::choose_pose(const Request& request, std::uint64_t& reasons) noexcept {
  const bool requested = (reasons & kNoWish) == 0;
  if (requested) {
    const Posture& to = request.posture;
    state_.held = {within(to.x, tuning_.sway, reasons),
                   within(to.y, tuning_.sway, reasons),
                   within(to.height, tuning_.bob, reasons),
                   to.roll,
                   to.pitch,
                   within(to.yaw, tuning_.lean, reasons)};
    limit_lean(state_.held[kRoll], state_.held[kPitch], reasons);
  } else if (state_.follows != 0) {
    const std::array<double, 3> nominal{state_.home[0], state_.home[1], nominal_};
    state_.held = stopping_place(state_.body, body_motion_);
    for (std::size_t i = 0; i < kRoll; ++i) state_.held[i] -= nominal[i];
  }
  state_.follows = requested ? 1 : 0;
}

/// Returns x and y of the body in m at which its centre of gravity is amid the feet, or above three of them.
Eigen::Vector2d LegController::above_support() const noexcept {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero(), three = Eigen::Vector2d::Zero();
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const Eigen::Vector2d place = Map(state_.places[leg].data()).head<2>();
    middle += place / kLegs;
    if (leg != state_.lifted) three += place / (kLegs - 1);
  }
  if (state_.lifted != kLegs) middle += kShift * (three - middle);
  const double height = nominal_ - ground_ + state_.centre[2];  // of the centre of gravity
  return middle - Map(state_.centre.data()).head<2>() + height / state_.up[2] * Map(state_.up.data()).head<2>();
}

/// Returns x and y of the body in m to which the request adds.
Eigen::Vector2d LegController::standing_place() const noexcept {
  return state_.lifted != kLegs ? above_support() : Eigen::Vector2d(state_.home[0], state_.home[1]);
}

/// The foot goes up after its share of the weight went to zero, and takes it again after it came down.
void LegController::move_foot(const Request& request, bool wanted, bool supported, std::uint64_t& reasons) noexcept {
  double& share = state_.share[state_.lifted];
  Vector3& target = state_.foot_target;
  const bool in_air = state_.foot[kZ].value > 1e-3;
  if (wanted && !in_air && target[2] == 0) {
    if (supported || share < 1) approach(share, 0, period_ / kLoadTime);
    if (share == 0) target = {0, 0, kMinLift * tuning_.lift};
  } else if (wanted) {
    const bool clear = state_.foot[kZ].value > 0.8 * kMinLift * tuning_.lift;
    const double highest = tuning_.lift + tuning_.foot_range;
    target = {clear ? within(request.posture.x, tuning_.foot_range, reasons) : 0,
              clear ? within(request.posture.y, tuning_.foot_range, reasons) : 0,
              std::clamp(request.posture.height, kMinLift * tuning_.lift, highest)};
    if (target[2] != request.posture.height) reasons |= kReasonOutOfReach;
  } else {
    const bool above = std::hypot(state_.foot[kX].value, state_.foot[kY].value) < kArrived;
    target = {0, 0, above ? 0.0 : std::max(target[2], kMinLift * tuning_.lift)};
    if (above && !in_air) approach(share, 1, period_ / kLoadTime);
  }
  const AxisBounds motion = paced(tuning_.foot, wanted ? state_.pace : 1);
  track(state_.foot, target, {motion, motion, motion}, period_);
  if (!set_angles()) reasons |= kReasonOutOfReach;
  if (!wanted && share == 1) state_.lifted = kLegs;
}

void LegController::lower(std::uint64_t& reasons) noexcept {
  if (state_.sinks == 0) {
    state_.held = {};
    const Eigen::Vector2d place = standing_place();
    const Pose nominal{place.x(), place.y(), nominal_, 0, 0, 0};
    track(state_.body, nominal, body_motion_, period_);
    if (!set_angles()) reasons |= kReasonOutOfReach;
    const bool arrived_all = body_arrived(nominal);
    if (state_.lifted != kLegs) move_foot({}, false, arrived_all, reasons);
    state_.elapsed = 0;
    state_.sinks = arrived_all && state_.lifted == kLegs ? 1 : 0;
    return;
  }
  rise(tuning_.rise_time - state_.elapsed, reasons);
  if (state_.elapsed >= tuning_.rise_time) enter(LegPhase::kLying, 0);
}

double LegController::lying(std::size_t joint) const noexcept {
  return legs_[joint / kLegJoints].lying[static_cast<Eigen::Index>(joint % kLegJoints)];
}

}  // namespace robot_control
