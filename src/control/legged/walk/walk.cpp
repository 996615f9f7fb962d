#include "control/legged/walk/walk.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "control/legged/stand/body_bounds.h"

namespace robot_control {
namespace {

constexpr double kMaxEndSpeed = 0.3;    // m/s, of a body of legs of kReferenceLeg whose walk may end
constexpr double kFastFrom = 0.4;       // m/s, of the feet (docs/evidence/derivations.md)
constexpr double kFastUntil = 0.3;      // m/s, likewise
constexpr double kMaxFootOffset = 0.1;  // of the leg length, of the feet at the end of a walk
constexpr double kInPlace = 3;          // s, after which a walk ends wherever the feet are
constexpr double kCarriedPart = 0.5;    // of the ranges and speeds of a standing body
constexpr double kOnTheSpot = 0.75;     // of what the legs can, in a pose: the rest is for a twist
constexpr double kLeanFactor = 0.7;     // of a pose that they do not carry on the spot
constexpr double kNominal = 0.0005;     // m, rad: a body this near to the nominal pose is in it
constexpr int kCarriedHalvings = 5;     // down to this part of a twist, 2⁻⁵
constexpr int kUseSamples = 8;          // of a swing: joints are fastest after 2, 4 and 6 of them
constexpr std::uint64_t kEmergencies = kReasonTimedOut | kReasonRefused | kReasonManySenders | kReasonPermitRamp;

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

}  // namespace

Walk::Walk(const LegModel& robot, const LegControllerParameters& parameters, double period)
    : period_(period),
      tuning_(leg_tuning(robot)),
      limiter_(twist_limits(parameters)),
      walker_(robot, all_gaits(parameters.gaits), parameters.friction, period),
      leg_use_(robot, nominal_stance(robot)),
      time_scale_(walker_.gaits()[kFastGait].period / kGaits[kFastGait].period),
      placed_(kMaxFootOffset * robot.legs[0].kinematics.length()) {
  const NominalStance stance = nominal_stance(robot);
  fastest_ = walking_speeds(robot, stance, walker_.gaits());
  for (const Eigen::Vector3d& foot : stance.feet)
    foot_distance_ = std::max(foot_distance_, (foot - stance.equations.centre_of_gravity).head<2>().norm());
  const std::array<AxisBounds, 6> bounds = body_bounds(robot);
  for (std::size_t i = 0; i < motion_.size(); ++i) motion_[i] = paced(bounds[2 + i], kCarriedPart);
}

bool Walk::requested(const Request& request) const noexcept {
  if (request.mode.kind == ModeKind::kGait) return has_gait(request.mode.index);
  return request.mode.kind == ModeKind::kStay && (parts_of(request) & kParts) != 0;
}

bool Walk::begin(State& state, const ControlInput& input, const std::array<TrackedAxis, 3>& body) const noexcept {
  const CarriedBody place = place_of(body);
  const bool in_range =
      std::abs(place[0]) <= kCarriedPart * tuning_.bob && std::hypot(place[1], place[2]) <= kCarriedPart * tuning_.lean;
  if (!nominal(place) && !(in_range && used(state, {}, place, kFastGait, rates_of(body)) <= 1)) return false;
  state = {};
  state.carried = body;
  walker_.begin(state.walker, *input.sensors, *input.state);
  return true;
}

bool Walk::step(State& state, const ControlInput& input, const Request& request, CommandFrame& out) noexcept {
  const bool wanted = requested(request);
  WalkingTwist target{};
  if (wanted) target = {request.twist.linear[0], request.twist.linear[1], request.twist.angular[2]};
  const double speed = std::hypot(target[0], target[1]);
  if (speed > input.permit->speed_limit) {
    out.reasons |= kReasonPermitSlow;
    for (double& axis : target) axis *= input.permit->speed_limit / speed;
  }
  const std::uint64_t gait = choose_gait(state, request, target);
  const WalkingTwist speeds = capable(state, gait);
  lean(state, request.posture, gait, out.reasons);
  WalkInput to{.sensors = input.sensors,
               .state = input.state,
               .twist = target,
               .body = place_of(state.carried),
               .rates = rates_of(state.carried),
               .gait = gait};
  for (double& axis : to.twist) axis /= std::max(1.0, used_part(target, speeds));
  const double carried = carried_part(state, to.twist, gait);
  for (double& axis : to.twist) axis *= carried;
  const double part = walker_.reachable_part(state.walker, to);
  if (carried * part < 1) {
    for (std::size_t i = 0; i < target.size(); ++i) target[i] = part * to.twist[i];
    out.reasons |= kReasonLegSpeed;
  }
  to.twist = limiter_.step(state.twist, target, speeds, (out.reasons & kEmergencies) != 0, period_, out.reasons);
  const bool all_down = state.walker.gait == kStandGait;
  state.idle = !wanted && to.twist == WalkingTwist{} ? state.idle + period_ : 0;
  const bool ends = state.idle > 0 && (all_down || may_end(state, input));
  to.gait = ends                             ? kStandGait
            : state.idle > 0                 ? kFastGait  // it sets the feet on their places
            : carries(state, gait, to.twist) ? gait
                                             : state.walker.gait;
  const bool planned = walker_.step(state.walker, to, out);
  out.twist_limited = {.linear = {to.twist[0], to.twist[1], 0}, .angular = {0, 0, to.twist[2]}};
  std::ranges::copy(to.body, out.legged.body.begin() + 2);
  return planned && !(ends && all_down && state.walker.lasted > kAllDown);
}

/// Returns true if the body is slow, and all feet are so near to their nominal places that the robot can lie down.
bool Walk::may_end(const State& state, const ControlInput& input) const noexcept {
  const Vector3& moves = input.state->base.twist_base.linear;
  const bool slow = std::hypot(moves[0], moves[1]) < kMaxEndSpeed * time_scale_;
  return slow &&
         (state.idle > kInPlace || walker_.farthest_foot(walker_.measure(*input.sensors, *input.state)) < placed_);
}

/// Returns the gait that is requested. Otherwise the slow gait, or the fast one from kFastFrom on until below
/// kFastUntil.
std::uint64_t Walk::choose_gait(State& state, const Request& request, const WalkingTwist& target) const noexcept {
  if (request.mode.kind == ModeKind::kGait && has_gait(request.mode.index)) {
    state.gait = request.mode.index;
  } else if (target != WalkingTwist{}) {
    const auto& now = state.twist.axes;
    const double fastest = std::max(pace_of(target), pace_of({now[0].speed, now[1].speed, now[2].speed})) / time_scale_;
    state.gait = fastest >= (state.gait == kFastGait ? kFastUntil : kFastFrom) ? kFastGait : kSlowGait;
  } else if (state.gait == 0) {
    state.gait = kFastGait;
  }
  return state.gait;
}

/// Returns the speeds that the gait in force and the wanted one can have. In its first period some feet still bear
/// since the last gait, whose speeds count as well.
WalkingTwist Walk::capable(const State& state, std::uint64_t wanted) const noexcept {
  const Walker::State& walk = state.walker;
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
bool Walk::carries(const State& state, std::uint64_t gait, const WalkingTwist& twist) const noexcept {
  constexpr double kTwistTolerance = 1e-9;
  if (used_part(twist, fastest_[gait]) > 1 + kTwistTolerance) return false;
  return gait == state.walker.gait || nominal(place_of(state.carried)) ||
         used(state, twist, place_of(state.carried), gait) <= 1;
}

/// Returns the speed of the fastest foot under the body in m/s.
double Walk::pace_of(const WalkingTwist& twist) const noexcept {
  return std::hypot(twist[0], twist[1]) + std::abs(twist[2]) * foot_distance_;
}

/// Returns what the gait in force and the wanted one use of what the legs can, at this twist in this pose. The pose
/// changes with `rates`.
double Walk::used(const State& state, const WalkingTwist& twist, const CarriedBody& body, std::uint64_t wanted,
                  const CarriedBody& rates) const noexcept {
  double used = 0;
  for (const std::uint64_t gait : {wanted, state.walker.gait}) {
    if (walker_.gaits()[gait].duty >= 1 || (used > 0 && gait == wanted)) continue;
    used = std::max(used, leg_use_.steady(walker_.gaits()[gait], twist, body, kUseSamples, rates) / kSpeedShare);
  }
  return used;
}

/// Returns the largest part of a twist that the legs carry in the pose in force and in its target. The nominal pose is
/// that of walking_speed.h. While nothing but the pose in force changes, the part changes by at most a step per cycle,
/// which bounds the work of a cycle.
double Walk::carried_part(State& state, const WalkingTwist& twist, std::uint64_t wanted) const noexcept {
  CarriedTwist last = state.carried_twist;
  CarriedTwist now{.twist = twist,
                   .bodies = {place_of(state.carried), state.lean_target},
                   .gaits = {wanted, state.walker.gait},
                   .part = last.part};
  if (now == last) return now.part;
  last.bodies[0] = now.bodies[0];
  const auto carries = [&](double part) {
    const WalkingTwist tried{part * twist[0], part * twist[1], part * twist[2]};
    return std::ranges::all_of(
        now.bodies, [&](const CarriedBody& body) { return nominal(body) || used(state, tried, body, wanted) <= 1; });
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
  state.carried_twist = now;
  return now.part;
}

/// Moves height, roll and pitch towards the requested ones.
void Walk::lean(State& state, const Posture& posture, std::uint64_t wanted, std::uint64_t& reasons) const noexcept {
  CarriedBody to{within(posture.height, kCarriedPart * tuning_.bob, reasons), posture.roll, posture.pitch};
  const double lean = std::hypot(to[1], to[2]), range = kCarriedPart * tuning_.lean;
  if (lean > range) {
    reasons |= kReasonOutOfReach;
    for (double* axis : {&to[1], &to[2]}) *axis *= range / lean;
  }
  const std::array gaits{wanted, state.walker.gait};
  if (to != state.lean_wanted || gaits != state.carried_twist.gaits) {
    state.lean_wanted = state.lean_target = to;
    for (int i = 0; i < kCarriedHalvings && !nominal(state.lean_target); ++i) {
      if (used(state, {}, state.lean_target, wanted) <= kOnTheSpot) break;
      for (double& axis : state.lean_target) axis *= kLeanFactor;
    }
  }
  if (state.lean_target != to) reasons |= kReasonOutOfReach;
  const WalkingTwist twist{state.twist.axes[0].speed, state.twist.axes[1].speed, state.twist.axes[2].speed};
  const CarriedBody before = place_of(state.carried);
  std::array<TrackedAxis, 3> next = state.carried;
  track(next, state.lean_target, motion_, period_);
  const CarriedBody after = place_of(next);
  const double uses = after == before ? 0 : used(state, twist, after, wanted, rates_of(next));
  if (uses > 1 && uses > used(state, twist, before, wanted, rates_of(state.carried))) {
    brake(state.carried, motion_, period_);
  } else {
    state.carried = next;
  }
}

}  // namespace robot_control
