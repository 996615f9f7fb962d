/// The phase in which the robot walks, and how it begins and ends.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "control/legged/leg_controller.h"

namespace robot_control {
namespace {

constexpr double kSlow = 0.3;         // m/s, of a body of legs of kReferenceLeg whose walk may end
constexpr double kFastFrom = 0.4;     // m/s, of the feet (docs/evidence/derivations.md)
constexpr double kFastUntil = 0.3;    // m/s, likewise
constexpr double kPlaced = 0.1;       // of the leg length, of the feet at the end of a walk
constexpr double kInPlace = 3;        // s, after which a walk ends wherever the feet are
constexpr double kCarriedPart = 0.5;  // of the ranges and speeds of a standing body
constexpr double kOnTheSpot = 0.75;   // of what the legs can, in a pose: the rest is for a twist
constexpr double kLessLean = 0.7;     // of a pose that they do not carry on the spot
constexpr double kNominal = 0.0005;   // m, rad: a body this near to the nominal pose is in it
constexpr int kCarriedHalvings = 5;   // down to this part of a twist, 2⁻⁵
constexpr int kUseSamples = 8;        // of a swing: joints are fastest after 2, 4 and 6 of them
constexpr std::uint64_t kEmergencies = kReasonTimedOut | kReasonRefused | kReasonManySenders | kReasonPermitRamp;

bool rests(const WalkingTwist& twist) noexcept {
  return twist[0] == 0 && twist[1] == 0 && twist[2] == 0;
}

/// Returns which part of what the legs can is used: Σ |xᵢ|/cᵢ.
double used_part(const WalkingTwist& twist, const WalkingTwist& capable) noexcept {
  double used = 0;
  for (std::size_t i = 0; i < twist.size(); ++i) used += std::abs(twist[i]) / capable[i];
  return used;
}

CarriedBody place_of(const std::array<TrackedAxis, 3>& axes) noexcept {
  return {axes[0].value, axes[1].value, axes[2].value};
}

CarriedBody rates_of(const std::array<TrackedAxis, 3>& axes) noexcept {
  return {axes[0].speed, axes[1].speed, axes[2].speed};
}

bool nominal(const CarriedBody& body) noexcept {
  return std::ranges::all_of(body, [](double axis) { return std::abs(axis) < kNominal; });
}

bool usable(const ControlInput& input) noexcept {
  return input.state != nullptr && input.state->head.cycle == input.sensors->head.cycle &&
         (input.state->base.flags & kStateValid) != 0;
}

}  // namespace

/// Returns true if this request asks the robot to walk.
bool LegController::walks(const Request& request) const noexcept {
  if (request.mode.kind == ModeKind::kGait) return known(request.mode);
  return request.mode.kind == ModeKind::kStay && (parts_of(request) & kWalk) != 0;
}

/// Begins to walk once the body is within its ranges, and the legs carry it on the spot. Until then it moves towards
/// its nominal pose.
void LegController::begin_walk(const ControlInput& input) noexcept {
  if (!usable(input)) return;
  const std::array<double, 3> nominal_pose{nominal_, 0, 0};
  for (std::size_t i = 0; i < nominal_pose.size(); ++i) {
    state_.carried[i] = state_.body[kZ + i];
    state_.carried[i].value -= nominal_pose[i];
  }
  const CarriedBody body = carried_body();
  const bool in_range =
      std::abs(body[0]) <= kCarriedPart * tuning_.bob && std::hypot(body[1], body[2]) <= kCarriedPart * tuning_.lean;
  if (!nominal(body) && !(in_range && used({}, body, kFastGait, rates_of(state_.carried)) <= 1)) return;
  state_.twist = {};
  state_.lean_wanted = state_.lean_target = {};
  state_.carried_twist = {};
  state_.gait = kStandGait;
  walker_.begin(state_.walk, *input.sensors, *input.state);
  enter(LegPhase::kWalking, 0);
}

void LegController::walk(const ControlInput& input, const Request& request, CommandFrame& out) noexcept {
  out.legged.phase = LegPhase::kWalking;
  if (!usable(input)) {
    out.reasons |= kReasonNoState;
    out.legged.phase = LegPhase::kLying;
    return pause();
  }
  state_.gap = 0;
  const bool wanted = walks(request);
  if (request.mode.kind == ModeKind::kLie) state_.lies_next = 1;
  if (wanted || request.mode.kind == ModeKind::kStand) state_.lies_next = 0;
  WalkingTwist target{};
  if (wanted) target = {request.twist.linear[0], request.twist.linear[1], request.twist.angular[2]};
  const double speed = std::hypot(target[0], target[1]);
  if (speed > input.permit->speed_limit) {
    out.reasons |= kReasonPermitSlow;
    for (double& axis : target) axis *= input.permit->speed_limit / speed;
  }
  const std::uint64_t gait = choose_gait(request, target);
  const WalkingTwist speeds = capable(gait);
  carry(request, gait, out.reasons);
  WalkInput to{.sensors = input.sensors,
               .state = input.state,
               .twist = target,
               .height = state_.carried[0].value,
               .roll = state_.carried[1].value,
               .pitch = state_.carried[2].value,
               .rates = {state_.carried[0].speed, state_.carried[1].speed, state_.carried[2].speed},
               .gait = gait};
  for (double& axis : to.twist) axis /= std::max(1.0, used_part(target, speeds));
  const double carried = carried_part(to.twist, gait);
  for (double& axis : to.twist) axis *= carried;
  const double part = walker_.part_in_reach(state_.walk, to);
  if (carried * part < 1) {
    for (std::size_t i = 0; i < target.size(); ++i) target[i] = part * to.twist[i];
    out.reasons |= kReasonLegSpeed;
  }
  const std::uint64_t now = state_.walk.gait;
  const WalkingTwist twist =
      limiter_.step(state_.twist, target, speeds, (out.reasons & kEmergencies) != 0, period_, out.reasons);
  const Vector3& moves = input.state->base.twist_base.linear;
  const bool slow = std::hypot(moves[0], moves[1]) < kSlow * time_scale();
  const bool all_down = state_.walk.gait == kStandGait;
  state_.idle = !wanted && rests(twist) ? state_.idle + period_ : 0;
  const bool ends = state_.idle > 0 && (all_down || (slow && (placed(input) || state_.idle > kInPlace)));
  to.twist = twist;
  to.gait = ends                   ? kStandGait
            : state_.idle > 0      ? kFastGait  // it sets the feet on their places
            : carries(gait, twist) ? gait
                                   : now;
  const bool planned = walker_.step(state_.walk, to, out);
  out.twist_limited = {.linear = {twist[0], twist[1], 0}, .angular = {0, 0, twist[2]}};
  for (std::size_t i = 0; i < 3; ++i) out.legged.body[kZ + i] = state_.carried[i].value;
  if (!planned || (ends && all_down && state_.walk.lasted > kAllDown)) stand_here(input);
}

/// Returns true if all feet are so near to their nominal places that the robot can lie down.
bool LegController::placed(const ControlInput& input) const noexcept {
  const WalkingBody body = walker_.measure(*input.sensors, *input.state);
  return walker_.farthest_foot(body) < kPlaced * legs_[0].kinematics.length();
}

/// Returns the gait that is requested. Otherwise the slow gait, or the fast one from kFastFrom on until below
/// kFastUntil.
std::uint64_t LegController::choose_gait(const Request& request, const WalkingTwist& target) noexcept {
  if (request.mode.kind == ModeKind::kGait && known(request.mode)) {
    state_.gait = request.mode.index;
  } else if (!rests(target)) {
    const auto& now = state_.twist.axes;
    const double fastest =
        std::max(pace_of(target), pace_of({now[0].speed, now[1].speed, now[2].speed})) / time_scale();
    state_.gait = fastest >= (state_.gait == kFastGait ? kFastUntil : kFastFrom) ? kFastGait : kSlowGait;
  } else if (state_.gait == 0) {
    state_.gait = kFastGait;
  }
  return state_.gait;
}

/// Returns the speeds that the gait in force and the wanted one can have. In its first period some feet still bear
/// since the last gait, whose speeds count as well.
WalkingTwist LegController::capable(std::uint64_t wanted) const noexcept {
  const Walker::State& walk = state_.walk;
  WalkingTwist speeds = fastest_[wanted];
  const auto bound = [&](std::uint64_t gait) {
    if (gait == kStandGait) return;
    for (std::size_t i = 0; i < speeds.size(); ++i) speeds[i] = std::min(speeds[i], fastest_[gait][i]);
  };
  bound(walk.gait);
  if (walk.lasted < walker_.gaits()[walk.gait].period) bound(walk.last);
  return speeds;
}

/// Returns true if the legs carry the body at this twist, in this gait and the pose in force.
bool LegController::carries(std::uint64_t gait, const WalkingTwist& twist) const noexcept {
  constexpr double kRounding = 1e-9;
  if (used_part(twist, fastest_[gait]) > 1 + kRounding) return false;
  return gait == state_.walk.gait || nominal(carried_body()) || used(twist, carried_body(), gait) <= 1;
}

/// Returns √(l / kReferenceLeg): times and speeds of robots of equal Froude number are as these.
double LegController::time_scale() const noexcept {
  return walker_.gaits()[kFastGait].period / kGaits[kFastGait].period;
}

/// Returns the speed of the fastest foot under the body in m/s.
double LegController::pace_of(const WalkingTwist& twist) const noexcept {
  return std::hypot(twist[0], twist[1]) + std::abs(twist[2]) * foot_distance_;
}

CarriedBody LegController::carried_body() const noexcept {
  return place_of(state_.carried);
}

/// Returns what the gait in force and the wanted one use of what the legs can, at this twist in this pose. The pose
/// changes with `rates`.
double LegController::used(const WalkingTwist& twist, const CarriedBody& body, std::uint64_t wanted,
                           const CarriedBody& rates) const noexcept {
  double used = 0;
  for (const std::uint64_t gait : {wanted, state_.walk.gait}) {
    if (walker_.gaits()[gait].duty >= 1 || (used > 0 && gait == wanted)) continue;
    used = std::max(used, leg_use_.steady(walker_.gaits()[gait], twist, body, kUseSamples, rates) / kOfJointSpeed);
  }
  return used;
}

/// Returns the largest part of a twist that the legs carry in the pose in force and in its target. The nominal pose is
/// that of walking_speed.h. While nothing but the pose in force changes, the part changes by at most a step per cycle,
/// which bounds the work of a cycle.
double LegController::carried_part(const WalkingTwist& twist, std::uint64_t wanted) noexcept {
  CarriedTwist last = state_.carried_twist;
  CarriedTwist now{.twist = twist,
                   .bodies = {carried_body(), state_.lean_target},
                   .gaits = {wanted, state_.walk.gait},
                   .part = last.part};
  if (now == last) return now.part;
  last.bodies[0] = now.bodies[0];
  const auto carries = [&](double part) {
    const WalkingTwist tried{part * twist[0], part * twist[1], part * twist[2]};
    return std::ranges::all_of(
        now.bodies, [&](const CarriedBody& body) { return nominal(body) || used(tried, body, wanted) <= 1; });
  };
  if (now == last) {
    constexpr double kStep = 1.0 / (1 << kCarriedHalvings);
    if (!carries(now.part)) {
      now.part = std::max(0.0, now.part - kStep);
    } else if (now.part < 1 && carries(now.part + kStep)) {
      now.part += kStep;
    }
  } else {
    double step = 0.5;
    now.part = carries(1) ? 1 : 0;
    for (int i = 0; i < kCarriedHalvings && (now.part < 1); ++i, step /= 2)
      if (carries(now.part + step)) now.part += step;
  }
  state_.carried_twist = now;
  return now.part;
}

/// Moves height, roll and pitch towards the requested ones.
void LegController::carry(const Request& request, std::uint64_t wanted, std::uint64_t& reasons) noexcept {
  CarriedBody to{within(request.posture.height, kCarriedPart * tuning_.bob, reasons), request.posture.roll,
                 request.posture.pitch};
  const double lean = std::hypot(to[1], to[2]), range = kCarriedPart * tuning_.lean;
  if (lean > range) {
    reasons |= kReasonOutOfReach;
    for (double* axis : {&to[1], &to[2]}) *axis *= range / lean;
  }
  const std::array gaits{wanted, state_.walk.gait};
  if (to != state_.lean_wanted || gaits != state_.carried_twist.gaits) {
    state_.lean_wanted = state_.lean_target = to;
    for (int i = 0; i < kCarriedHalvings && !nominal(state_.lean_target); ++i) {
      if (used({}, state_.lean_target, wanted) <= kOnTheSpot) break;
      for (double& axis : state_.lean_target) axis *= kLessLean;
    }
  }
  if (state_.lean_target != to) reasons |= kReasonOutOfReach;
  const std::array bounds{paced(body_motion_[kZ], kCarriedPart), paced(body_motion_[kRoll], kCarriedPart),
                          paced(body_motion_[kPitch], kCarriedPart)};
  const WalkingTwist twist{state_.twist.axes[0].speed, state_.twist.axes[1].speed, state_.twist.axes[2].speed};
  const CarriedBody before = carried_body();
  std::array<TrackedAxis, 3> next = state_.carried;
  track(next, state_.lean_target, bounds, period_);
  const CarriedBody after = place_of(next);
  const double uses = after == before ? 0 : used(twist, after, wanted, rates_of(next));
  if (uses > 1 && uses > used(twist, before, wanted, rates_of(state_.carried))) {
    brake(state_.carried, bounds, period_);
  } else {
    state_.carried = next;
  }
}

/// Holds the body from now on by the angles of its joints, on the feet where they are. It will lie amid them.
void LegController::stand_here(const ControlInput& input) noexcept {
  const WalkingBody body = walker_.measure(*input.sensors, *input.state);
  const bool lies_next = state_.lies_next != 0;
  state_.body = {};
  state_.body[kZ].value = ground_ - state_.walk.ground[0];
  state_.body[kRoll].value = body.roll;
  state_.body[kPitch].value = body.pitch;
  Eigen::Vector2d lies = Eigen::Vector2d::Zero();  // m, where the body lies
  for (std::size_t leg = 0; leg < kLegs; ++leg)
    lies += (body.feet[leg] - legs_[leg].kinematics.position(legs_[leg].lying)).head<2>() / kLegs;
  state_.body[kX].value = -lies.x();
  state_.body[kY].value = -lies.y();
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const Eigen::Vector3d& foot = body.feet[leg];
    state_.places[leg] = {foot.x() - lies.x(), foot.y() - lies.y(), foot.z() + state_.body[kZ].value};
  }
  state_.share.fill(1);
  state_.lifted = kLegs;
  state_.angles = body.angles;
  const Eigen::Vector3d& centre = body.equations.centre_of_gravity;
  state_.centre = {centre.x(), centre.y(), centre.z()};
  state_.up = {0, 0, 1};
  const Eigen::Vector2d middle = above_support();
  state_.home = {middle.x(), middle.y()};
  state_.held = {};
  state_.follows = state_.blocked = 0;
  state_.velocity = state_.acceleration = {};
  enter(LegPhase::kStanding, 0);
  state_.margin = margin();
  state_.lies_next = lies_next ? 1 : 0;
}

}  // namespace robot_control
