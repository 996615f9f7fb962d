#include "control/legged/walk/walker.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <optional>

#include "control/legged/posture/ground_slope.h"
#include "control/legged/walk/foothold.h"
#include "control/legged/walk/walking_speed.h"
#include "machine/gravity.h"

namespace robot_control {
namespace {

constexpr double kFarthest = 0.2;           // m, the target from the robot, of a leg of kReferenceLeg
constexpr double kFarthestYaw = 0.3;        // rad
constexpr double kGroundTime = 0.05;        // s, in which the ground follows the feet
constexpr double kMinFootSpread = 0.1;      // of a leg length, by how much the feet have to be apart to show a slope
constexpr double kEarliestTouchdown = 0.5;  // of the swing, from which on a foot may touch down
constexpr double kTouches = 0.5;            // probability of a contact
constexpr int kReachHalvings = 6;           // down to this part of a twist, 2⁻⁶
constexpr double kTouchTime = 0.005;        // s, for which an early foot touches: the observed load is noisy in the air
constexpr double kTouchRadius = 0.003;  // m, in which it stays meanwhile: a wrong angle of a joint looks like a load

using Map = Eigen::Map<Eigen::Vector3d>;
using ConstMap = Eigen::Map<const Eigen::Vector3d>;

Vector3 plain(const Eigen::Vector3d& vector) noexcept {
  return {vector.x(), vector.y(), vector.z()};
}

double ground_below(const Walker::State& state, const Eigen::Vector3d& place) noexcept {
  return state.ground[0] + state.ground[1] * place.x() + state.ground[2] * place.y();
}

}  // namespace

Walker::Walker(const LegModel& robot, const Gaits& gaits, double friction, double period)
    : period_(period),
      legs_(robot.legs),
      dynamics_(robot),
      tuning_(leg_tuning(robot)),
      length_(robot.leg_length()),
      plan_parameters_([&] {
        ForcePlanParameters parameters =
            force_plan_parameters(dynamics_.mass(), nominal_stance(robot).inertia(), robot.leg_length());
        parameters.friction = friction;
        return parameters;
      }()),
      plan_(plan_parameters_) {
  for (std::size_t i = 0; i < kLegsJoints; ++i) effort_limits_[i] = kEffortShare * robot.joints[i].effort_limit;
  const NominalStance stance = nominal_stance(robot);
  for (const Gait& gait : gaits) gaits_.push_back(gait_of(robot, stance, gait));
  const Eigen::Vector3d& centre = stance.equations.centre_of_gravity;
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    nominal_[leg] = (stance.feet[leg] - centre).head<2>();
    height_ += (centre.z() - stance.feet[leg].z() + legs_[leg].foot_radius) / kLegs;
  }
}

WalkingBody Walker::measure(const SensorFrame& sensors, const StateFrame& estimate) const noexcept {
  const Quaternion& q = estimate.base.attitude;
  const Eigen::Matrix3d attitude = Eigen::Quaterniond(q[3], q[0], q[1], q[2]).toRotationMatrix();
  WalkingBody body;
  body.turned =
      Eigen::AngleAxisd(-std::atan2(attitude(1, 0), attitude(0, 0)), Eigen::Vector3d::UnitZ()).toRotationMatrix() *
      attitude;
  LeggedMotion motion;
  for (std::size_t i = 0; i < kLegsJoints; ++i) {
    motion.angles[i] = sensors.joints[i].position;
    motion.rates[i] = valid_velocity(sensors.joints[i]);
  }
  motion.linear = ConstMap(estimate.base.twist_base.linear.data());
  motion.angular = ConstMap(estimate.base.twist_base.angular.data());
  motion.gravity = -kGravity * body.turned.row(2).transpose();
  body.velocity = body.turned * motion.linear;
  body.rate = body.turned * motion.angular;
  body.angles = motion.angles;
  body.rates = motion.rates;
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    Eigen::Vector3d foot;
    body.jacobians[leg] = legs_[leg].kinematics.jacobian(LegModel::angles_of(motion.angles, leg), foot);
    body.feet[leg] = body.turned * foot;
  }
  dynamics_.step(motion, body.equations);
  body.centre = body.turned * body.equations.centre_of_gravity;
  body.moves = body.velocity + body.rate.cross(body.centre);
  body.roll = std::atan2(body.turned(2, 1), body.turned(2, 2));
  body.pitch = -std::asin(std::clamp(body.turned(2, 0), -1.0, 1.0));
  return body;
}

void Walker::begin(State& state, const SensorFrame& sensors, const StateFrame& estimate) const noexcept {
  state = {};
  const WalkingBody body = measure(sensors, estimate);
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    state.bears[leg] = 1;
    state.footprints[leg] = plain(body.feet[leg]);
  }
  state.ground = plain(fit_ground(state));
  state.planned = plan_cycles(period_);
}

bool Walker::step(State& state, const WalkInput& input, CommandFrame& out) noexcept {
  const WalkingBody body = measure(*input.sensors, *input.state);
  move(state, input, body);
  turn_clock(state, input.gait);
  const bool changed = choose_feet(state, input, body);
  lift_again(state, input, body);
  if (++state.planned >= plan_cycles(period_) || changed) plan(state, input, body);
  const Gait& gait = this->gait(state);
  out.legged.gait = state.gait;
  out.legged.gait_phase = state.phase;
  out.legged.slope = {state.ground[1], state.ground[2]};
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const bool bears = state.bears[leg] != 0;
    if (bears) {
      bear(state, body, leg, out);
    } else {
      swing(state, input, body, leg, out);
    }
    const double part = gait.leg_phase(leg, state.phase) / gait.duty;
    const bool early = gait.duty < 1 && !gait.bears(leg, state.phase);
    const double done = gait.duty >= 1 ? 0.5 : early ? 0 : part;
    out.contact_schedule[leg] = bears ? std::max(done, period_) : 0;
  }
  if (out.legged.risers != 0) out.reasons |= kReasonMetRiser;
  if (out.legged.reaches != 0) out.reasons |= kReasonReaching;
  if (state.failures > 0) out.reasons |= kReasonNoPlan;
  return state.failures <= kFailures;
}

/// Moves what is kept in level axes, which move and turn with the body.
void Walker::move(State& state, const WalkInput& input, const WalkingBody& body) const noexcept {
  const Eigen::Vector3d turning(0, 0, body.rate.z());
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    for (Vector3* kept : {&state.footprints[leg], &state.departs[leg], &state.touch_places[leg]}) {
      Map place(kept->data());
      place -= period_ * (body.velocity + turning.cross(place));
    }
    const bool stands = state.bears[leg] != 0 && input.state->contacts[leg].probability >= kTouches;
    if (stands) state.footprints[leg] = plain(body.feet[leg]);
  }
  const double farthest = kFarthest * length_ / kReferenceLeg;
  std::array<double, 3>& target = state.target;
  const double half = gait(state).period / 2;
  const std::array<double, 3> moves{body.velocity.x(), body.velocity.y(), body.rate.z()};
  for (std::size_t i = 0; i < 2; ++i) state.follows[i] += period_ / half * (input.twist[i] - state.follows[i]);
  state.follows[2] = input.twist[2];
  for (std::size_t i = 0; i < moves.size(); ++i) target[i] += period_ * (state.follows[i] - moves[i]);
  for (std::size_t i = 0; i < 2; ++i) target[i] = std::clamp(target[i], -farthest, farthest);
  target[2] = std::clamp(target[2], -kFarthestYaw, kFarthestYaw);
  state.ground[0] -= period_ * body.velocity.z();
  Map(state.ground.data()) += period_ / kGroundTime * (fit_ground(state) - Map(state.ground.data()));
}

/// Returns the plane on which the feet bore last: its height at the base's origin, and its slopes to the front and
/// left.
Eigen::Vector3d Walker::fit_ground(const State& state) const noexcept {
  const double level = kMinFootSpread * length_;
  Eigen::Matrix3d squares = Eigen::Vector3d(0, level * level, level * level).asDiagonal();
  Eigen::Vector3d heights = Eigen::Vector3d::Zero();
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const ConstMap foot(state.footprints[leg].data());
    const Eigen::Vector3d place(1, foot.x(), foot.y());
    squares += place * place.transpose();
    heights += (foot.z() - legs_[leg].foot_radius) * place;
  }
  return squares.inverse() * heights;
}

bool Walker::changes_after(const State& state, std::uint64_t wanted, double later) const noexcept {
  return wanted != kStandGait && wanted != state.gait && state.lasted + later > gait(state).period - period_;
}

void Walker::begin_gait(State& state, std::uint64_t next) const noexcept {
  state.phase = gaits_[next].begins_after(gait(state));
  state.last = state.gait;
  state.gait = next;
  state.lasted = 0;
}

void Walker::turn_clock(State& state, std::uint64_t wanted) const noexcept {
  const Gait& gait = this->gait(state);
  state.lasted += period_;
  if (gait.duty >= 1) {
    if (wanted == kStandGait) return;
    begin_gait(state, wanted);
    return;
  }
  const double step = period_ / gait.period;
  state.phase += step;
  const bool wraps = state.phase >= 1;
  state.phase -= std::floor(state.phase);
  double farthest = 0;
  for (std::size_t leg = 0; leg < kLegs; ++leg) farthest = std::max(farthest, gait.swung(leg, state.phase));
  const bool ends = wanted == kStandGait && farthest * (1 - gait.duty) < 1.5 * step;
  const bool changes = wraps && changes_after(state, wanted, 0);
  if (!ends && !changes) return;
  state.swings = {};  // a foot that then swings begins where it is, in the air or not
  begin_gait(state, wanted);
  if (ends) state.target = {};
}

/// Returns true if other feet bear than before.
bool Walker::choose_feet(State& state, const WalkInput& input, const WalkingBody& body) const noexcept {
  const Gait& gait = this->gait(state);
  const std::array<std::uint64_t, kLegs> before = state.bears;
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const bool swings = state.swings[leg] != 0 ? !gait.bears(leg, state.phase)
                                               : gait.swings_since(leg, state.phase, state.lasted + period_);
    const bool touches = input.state->contacts[leg].probability >= kTouches &&
                         (body.feet[leg] - ConstMap(state.touch_places[leg].data())).norm() <= kTouchRadius;
    state.touch_times[leg] = touches ? state.touch_times[leg] + period_ : 0;
    if (!touches) state.touch_places[leg] = plain(body.feet[leg]);
    if (!swings) {
      state.bears[leg] = 1;
    } else if (state.swings[leg] == 0) {
      state.bears[leg] = 0;
      state.footprints[leg] = state.departs[leg] = plain(body.feet[leg]);
      state.departed[leg] = gait.swung(leg, state.phase);
    } else if (gait.swung(leg, state.phase) > kEarliestTouchdown && state.touch_times[leg] >= kTouchTime) {
      state.bears[leg] = 1;
    }
    state.swings[leg] = swings ? 1 : 0;
  }
  return state.bears != before;
}

/// Returns where a foot in the air lands, in m from the base's origin.
Eigen::Vector3d Walker::landing(const State& state, const WalkInput& input, const WalkingBody& body,
                                std::size_t leg) const noexcept {
  const Gait& gait = this->gait(state);
  FootholdInput at{.nominal = nominal_[leg],
                   .requested = {input.twist[0], input.twist[1]},
                   .measured = body.moves.head<2>(),
                   .yaw_rate = input.twist[2],
                   .until_landing = (1 - gait.swung(leg, state.phase)) * gait.swing_time(),
                   .stance_time = gait.stance_time(),
                   .height = height_ + input.body[0],
                   .leg_length = length_};
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  place.head<2>() = body.centre.head<2>() + foothold(at);
  place.z() = ground_below(state, place) + legs_[leg].foot_radius;
  return place;
}

void Walker::plan(State& state, const WalkInput& input, const WalkingBody& body) noexcept {
  const Gait& gait = this->gait(state);
  ForcePlanInput to{.ground = ground_axes(state.ground[1], state.ground[2])};
  to.place << body.roll, body.pitch, 0, 0, 0, body.centre.z() - ground_below(state, body.centre);
  to.speed << body.rate, body.moves;
  to.target << input.body[1] + std::atan(state.ground[2]), input.body[2] - std::atan(state.ground[1]), state.target[2],
      state.target[0], state.target[1], (height_ + input.body[0]) / to.ground(2, 2);
  to.target_speed << input.rates[1], input.rates[2], input.twist[2], input.twist[0], input.twist[1], input.rates[0];
  to.steps = std::min(kPlanSteps, static_cast<std::size_t>(5 / gait.duty));
  const double step = plan_parameters_.horizon / static_cast<double>(to.steps);
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const bool bears = state.bears[leg] != 0;
    const double until = (1 - gait.swung(leg, state.phase)) * gait.swing_time();
    to.feet[leg] = (bears ? body.feet[leg] : landing(state, input, body, leg)) - body.centre;
    to.feet[leg].z() -= legs_[leg].foot_radius;
    to.bears[0][leg] = bears;
    for (std::size_t i = 1; i < to.steps; ++i) {
      const double later = (static_cast<double>(i) + 0.5) * step;
      const bool landed = bears && state.swings[leg] != 0 && later < until;
      to.bears[i][leg] = landed || will_bear(state, input.gait, leg, later);
    }
  }
  const ForcePlanResult result = plan_.step(to);
  state.planned = 0;
  if (result.outcome != QpOutcome::kSolved) {
    ++state.failures;
    return;
  }
  state.failures = 0;
  for (std::size_t leg = 0; leg < kLegs; ++leg) state.forces[leg] = plain(result.forces[leg]);
}

bool Walker::will_bear(const State& state, std::uint64_t wanted, std::size_t leg, double later) const noexcept {
  const Gait& gait = this->gait(state);
  const double left = (1 - state.phase) * gait.period;
  if (later < left || !changes_after(state, wanted, left)) return gait.bears(leg, state.phase + later / gait.period);
  const Gait& next = gaits_[wanted];
  return !next.swings_since(leg, next.begins_after(gait) + (later - left) / next.period, later - left);
}

double Walker::bears_for(const State& state, std::uint64_t wanted, std::size_t leg) const noexcept {
  const Gait& gait = this->gait(state);
  const double left = (1 - state.phase) * gait.period, bears = gait.bears_for(leg, state.phase);
  if (bears < left || !changes_after(state, wanted, left)) return bears;
  const Gait& next = gaits_[wanted];
  return left + next.bears_for(leg, next.begins_after(gait));
}

double Walker::reachable_part(const State& state, const WalkInput& input) const noexcept {
  double part = 1;
  if (gait(state).duty >= 1) return part;
  const Eigen::Matrix3d leaning = (Eigen::AngleAxisd(input.body[2], Eigen::Vector3d::UnitY()) *
                                   Eigen::AngleAxisd(input.body[1], Eigen::Vector3d::UnitX()))
                                      .toRotationMatrix();  // base axes → those of the ground
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    if (state.bears[leg] == 0) continue;
    const LegKinematics& kinematics = legs_[leg].kinematics;
    LegAngles now;
    for (std::size_t i = 0; i < kLegJoints; ++i) now[i] = input.sensors->joints[kLegJoints * leg + i].position;
    const Eigen::Vector3d foot = kinematics.position(now);
    const Eigen::Vector3d way =
        bears_for(state, input.gait, leg) * (leaning.transpose() * velocity_below(leaning * foot, input.twist));
    const double longest = std::max(kLengthShare * kinematics.length(), kinematics.stretch(now));
    const auto reaches = [&](double of_twist) {
      const std::optional<LegAngles> end = kinematics.reached(foot + of_twist * way);
      return end && kinematics.stretch(*end) <= longest;
    };
    if (way.isZero() || reaches(part)) continue;
    double step = part / 2;
    part = 0;
    for (int i = 0; i < kReachHalvings; ++i, step /= 2)
      if (reaches(part + step)) part += step;
  }
  return part;
}

double Walker::farthest_foot(const WalkingBody& body) const noexcept {
  double farthest = 0;
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const Eigen::Vector2d place = (body.feet[leg] - body.centre).head<2>();
    farthest = std::max(farthest, (place - nominal_[leg]).norm());
  }
  return farthest;
}

}  // namespace robot_control
