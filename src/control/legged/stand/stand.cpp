#include "control/legged/stand/stand.h"

#include <algorithm>
#include <cmath>

#include "control/legged/posture/ground_slope.h"
#include "control/legged/stand/body_bounds.h"
#include "control/legged/walk/walker.h"

namespace robot_control {
namespace {

constexpr double kMinLift = 0.25;       // of the lift, the lowest height of a foot in the air
constexpr double kSetDown = 0.1;        // m/s, of a foot that lies above the ground
constexpr double kArrived = 0.0005;     // m and rad
constexpr double kArrivedSpeed = 0.02;  // m/s and rad/s
constexpr double kMargin = 0.03;        // of `spare`, for what the feet roll while the body brakes
constexpr std::uint64_t kNoRequest =
    kReasonNoCommand | kReasonTimedOut | kReasonRefused | kReasonManySenders | kReasonNotLying;

void approach(double& value, double target, double step) noexcept {
  value += std::clamp(target - value, -step, step);
}

bool arrived(const std::array<TrackedAxis, 6>& body, const Stance::Pose& target) noexcept {
  for (std::size_t i = 0; i < target.size(); ++i)
    if (std::abs(body[i].value - target[i]) >= kArrived || std::abs(body[i].speed) >= kArrivedSpeed) return false;
  return true;
}

}  // namespace

std::uint64_t lifted_by(const Mode& mode) noexcept {
  return mode.kind == ModeKind::kLift ? std::min<std::uint64_t>(mode.index, kLegs) : kLegs;
}

Stand::Stand(const LegModel& robot, double period) : Stance(robot, period), body_motion_(body_bounds(robot)) {}

void Stand::begin(State& state) const noexcept {
  state.body = {};
  state.share = {};
  state.lifted = kLegs;
  state.held = {};
  state.follows = 0;
  for (std::size_t leg = 0; leg < kLegs; ++leg)
    Eigen::Map<Eigen::Vector3d>(state.places[leg].data()) = legs_[leg].kinematics.position(legs_[leg].lying);
}

void Stand::begin(State& state, const WalkingBody& body, const Vector3& ground) const noexcept {
  state = {};
  state.angles = body.angles;
  const bool level = std::hypot(ground[1], ground[2]) < std::tan(kLevelSlope);
  const Eigen::Matrix3d back =
      (level ? Eigen::Matrix3d(Eigen::Matrix3d::Identity()) : ground_axes(ground[1], ground[2])).transpose();
  const Eigen::Matrix3d turned = back * body.turned;
  std::array<Eigen::Vector3d, kLegs> feet;
  Eigen::Vector2d lies = Eigen::Vector2d::Zero();  // m, where the body will lie amid its feet
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    feet[leg] = back * body.feet[leg];
    lies += (feet[leg] - legs_[leg].kinematics.position(legs_[leg].lying)).head<2>() / kLegs;
  }
  const Pose pose{-lies.x(),
                  -lies.y(),
                  ground_ - back(2, 2) * ground[0],
                  std::atan2(turned(2, 1), turned(2, 2)),
                  -std::asin(std::clamp(turned(2, 0), -1.0, 1.0)),
                  std::atan2(turned(1, 0), turned(0, 0))};
  for (std::size_t i = 0; i < pose.size(); ++i) state.body[i].value = pose[i];
  for (std::size_t leg = 0; leg < kLegs; ++leg)
    state.places[leg] = {feet[leg].x() - lies.x(), feet[leg].y() - lies.y(), feet[leg].z() + pose[kZ]};
  state.up = {back(0, 2), back(1, 2), back(2, 2)};
  state.share.fill(1);
  Eigen::Map<Eigen::Vector3d>(state.centre.data()) = body.equations.centre_of_gravity;
  find_home(state);
  set_margin(state);
}

void Stand::set_margin(State& state) const noexcept {
  state.margin = std::min(kMargin, spare(state, pose(state)));
}

void Stand::find_home(State& state) const noexcept {
  const Eigen::Vector2d middle = above_support(state);
  state.home = {middle.x(), middle.y()};
}

void Stand::rise(State& state, double elapsed, std::uint64_t& reasons) const noexcept {
  find_home(state);
  sink(state, elapsed, reasons);
}

void Stand::sink(State& state, double left, std::uint64_t& reasons) const noexcept {
  const double part = smooth_step(left / tuning_.rise_time);
  const double standing[3] = {state.home[0], state.home[1], nominal_};
  for (std::size_t i = 0; i < 3; ++i) {
    const double before = state.body[i].value;
    state.body[i].value = part * standing[i];
    state.body[i].speed = (state.body[i].value - before) / period_;
  }
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    approach(state.places[leg][2], ground_ + legs_[leg].foot_radius, kSetDown * period_);
    state.share[leg] = std::clamp(left / kLoadTime, 0.0, 1.0);
  }
  set_angles(state, reasons);
}

void Stand::step(State& state, const Request& request, bool walks, double speed_limit,
                 std::uint64_t& reasons) const noexcept {
  const double pace = std::min(1.0, speed_limit / body_motion_[kX].speed);
  const std::uint64_t wanted = lifted_by(request.mode);
  if (state.lifted == kLegs && wanted != kLegs) {
    state.lifted = wanted;
    state.foot = {};
    state.foot_target = {};
  }
  if (state.lifted == kLegs && !walks) {
    choose_pose(state, request.posture, reasons);
  } else {
    state.held = {};
    state.follows = 0;
  }
  const Pose nominal = nominal_pose(state);
  Pose target = state.held;
  for (std::size_t i = 0; i < kRoll; ++i) target[i] += nominal[i];
  const bool reached = move(state, target, pace, reasons);
  if (state.lifted != kLegs)
    move_foot(state, state.lifted == wanted ? &request.posture : nullptr, reached, pace, reasons);
}

bool Stand::settle(State& state, std::uint64_t& reasons) const noexcept {
  state.held = {};
  const Pose nominal = nominal_pose(state);
  track(state.body, nominal, body_motion_, period_);
  set_angles(state, reasons);
  const bool arrived_all = arrived(state.body, nominal);
  if (state.lifted != kLegs) move_foot(state, nullptr, arrived_all, 1, reasons);
  return arrived_all && state.lifted == kLegs;
}

std::array<TrackedAxis, 3> Stand::lean(const State& state) const noexcept {
  std::array lean{state.body[kZ], state.body[kRoll], state.body[kPitch]};
  lean[0].value -= nominal_;
  return lean;
}

void Stand::report(const State& state, LeggedCommand& out) const noexcept {
  const std::array<double, 3> nominal{state.home[0], state.home[1], nominal_};
  for (std::size_t i = 0; i < state.body.size(); ++i) out.body[i] = state.body[i].value - (i < kRoll ? nominal[i] : 0);
}

/// Returns the pose of the body to which the request adds.
Stance::Pose Stand::nominal_pose(const State& state) const noexcept {
  if (state.lifted == kLegs) return {state.home[0], state.home[1], nominal_, 0, 0, 0};
  const Eigen::Vector2d place = above_support(state);
  return {place.x(), place.y(), nominal_, 0, 0, 0};
}

void Stand::choose_pose(State& state, const Posture& to, std::uint64_t& reasons) const noexcept {
  const bool requested = (reasons & kNoRequest) == 0;
  if (requested) {
    state.held = {within(to.x, tuning_.sway, reasons),
                  within(to.y, tuning_.sway, reasons),
                  within(to.height, tuning_.bob, reasons),
                  to.roll,
                  to.pitch,
                  within(to.yaw, tuning_.lean, reasons)};
    limit_lean(state, reasons);
  } else if (state.follows != 0) {
    const Pose nominal = nominal_pose(state);
    state.held = stopping_place(state.body, body_motion_);
    for (std::size_t i = 0; i < kRoll; ++i) state.held[i] -= nominal[i];
  }
  state.follows = requested ? 1 : 0;
}

/// Makes the lean of roll and pitch together, from the vertical, at most the range or the slope, and notes if it was
/// beyond.
void Stand::limit_lean(State& state, std::uint64_t& reasons) const noexcept {
  double &roll = state.held[kRoll], &pitch = state.held[kPitch];
  const double slope_roll = std::asin(state.up[1]), slope_pitch = -std::asin(state.up[0]);
  const double lean = std::hypot(roll + slope_roll, pitch + slope_pitch);
  const double range = std::max(tuning_.lean, std::hypot(slope_roll, slope_pitch));
  if (lean <= range) return;
  reasons |= kReasonOutOfReach;
  roll = (roll + slope_roll) * range / lean - slope_roll;
  pitch = (pitch + slope_pitch) * range / lean - slope_pitch;
}

/// Moves the body towards a pose. Returns true where it has arrived.
bool Stand::move(State& state, const Pose& target, double pace, std::uint64_t& reasons) const noexcept {
  const bool moves = stopping_time(state.body, body_motion_) > 0;
  if (state.blocked == 0 || !moves || target != state.blocked_target) {
    std::array<TrackedAxis, 6> next = state.body;
    std::array<AxisBounds, 6> motion = body_motion_;
    for (AxisBounds& axis : motion) axis = paced(axis, pace);
    track(next, target, motion, period_);
    const double left = spare(state, stopping_place(next, body_motion_));
    const bool leaves = left < state.margin && left < spare(state, stopping_place(state.body, body_motion_));
    state.blocked = leaves ? 1 : 0;
    state.blocked_target = target;
    if (!leaves) state.body = next;
  }
  if (state.blocked != 0) {
    brake(state.body, body_motion_, period_);
    reasons |= kReasonOutOfReach;
  }
  set_angles(state, reasons);
  if (arrived(state.body, target)) return true;
  if (pace < 1) reasons |= kReasonPermitSlow;
  return false;
}

/// The foot goes up to the `wanted` place after its share of the weight went to zero. Without one it takes its share
/// again after it came down.
void Stand::move_foot(State& state, const Posture* wanted, bool supported, double pace,
                      std::uint64_t& reasons) const noexcept {
  double& share = state.share[state.lifted];
  Vector3& target = state.foot_target;
  const double lowest = kMinLift * tuning_.lift;
  const bool in_air = state.foot[kZ].value > 1e-3;
  if (wanted == nullptr) {
    const bool above = std::hypot(state.foot[kX].value, state.foot[kY].value) < kArrived;
    target = {0, 0, above ? 0.0 : std::max(target[2], lowest)};
    if (above && !in_air) approach(share, 1, period_ / kLoadTime);
  } else if (!in_air && target[2] == 0) {
    if (supported || share < 1) approach(share, 0, period_ / kLoadTime);
    if (share == 0) target = {0, 0, lowest};
  } else {
    const bool clear = state.foot[kZ].value > 0.8 * lowest;
    target = {clear ? within(wanted->x, tuning_.foot_range, reasons) : 0,
              clear ? within(wanted->y, tuning_.foot_range, reasons) : 0,
              std::clamp(wanted->height, lowest, tuning_.lift + tuning_.foot_range)};
    if (target[2] != wanted->height) reasons |= kReasonOutOfReach;
  }
  const AxisBounds motion = paced(tuning_.foot, wanted != nullptr ? pace : 1);
  track(state.foot, target, {motion, motion, motion}, period_);
  set_angles(state, reasons);
  if (wanted == nullptr && share == 1) state.lifted = kLegs;
}

}  // namespace robot_control
