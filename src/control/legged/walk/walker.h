#pragma once
/// Walks: from the measured state of body and legs, and the twist that is requested, to the efforts of the joints.
///
/// The level axes have the body's heading and a vertical z; their origin is that of the base.
///
///   clock     the gait's phase says which feet bear (gait.h). Another gait begins where the phase wraps, after a whole
///             period of this one: until then, its feet stand where the last gait put them. A foot that then swings
///             begins its swing where it is. One whose swing would have begun before the gait stands until its next
///             one. A walk ends in a cycle in which no foot is far from where it left the ground
///   contact   a foot that touches the ground in the second half of its swing, for kTouchTime within kTouchRadius, bears
///             from then on. A foot that is late is pushed down by the force that it is to bear, which fades from
///             kReachSpeed to twice that: it meets lower ground without a blow
///   riser     a foot that is kMetRiser behind its path over ground, and is held there, has met a riser in the part
///             kFirstLift … kLastLift of its swing. A push moves the path away from a foot that is not held. The foot
///             goes kBackOff back, and over the riser by another path from there to its foothold
///   ground    is the plane through the places where the feet bore last. So a foot lands where the others stand,
///             whatever the error of the estimated tilt
///   target    moves from where the robot was, with the twist, its velocity through a low pass of half a period: a body
///             follows it when the next feet have landed. It stays within kFarthest of the robot
///   slope     the body is parallel to the ground, at its height across it; μ is that of force_plan.h
///   plan      every kPlanTime or cycle, and where other feet bear, the forces of the feet (force_plan.h), which knows
///             the gait that follows
///   stance    τ = h − Jᵀ f, f the planned force, h what holds the leg itself. f is scaled down until each |τ| is
///             within the joint's limit, so that f stays within friction. The torque of a swing's impedance is added
///             where it turns a joint back from kFromEnd before an end of its range
///   reach     the twist that is requested keeps each foot that bears in reach until its next swing, within the ranges
///             of its joints and kLengthShare of its leg's length (walking_speed.h), or no farther than it is. A foot that
///             landed for another twist bounds it by that
///   swing     the foot follows swing.h to its foothold (foothold.h) with the impedance of standing, and the efforts M
///             q̈ + h of its own leg. Each joint stays kFromEnd away from the ends of its range
///
/// If a plan fails, the last forces stay for up to kFailures plans (kReasonNoPlan).

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>

#include "control/legged/leg_tuning.h"
#include "control/legged/stand/nominal_stance.h"
#include "control/legged/tracked_axis.h"
#include "control/legged/walk/force_plan.h"
#include "control/legged/walk/gait_table.h"
#include "control/legged/walk/leg_use.h"
#include "control/legged/walk/swing.h"
#include "control/legged/walk/twist_limiter.h"
#include "machine/legs/leg_dynamics.h"
#include "machine/legs/leg_model.h"
#include "signals/command_frame.h"
#include "signals/sensor_frame.h"
#include "signals/state_frame.h"

namespace robot_control {

struct WalkInput {
  const SensorFrame* sensors = nullptr;  ///< all joints are measured
  const StateFrame* state = nullptr;     ///< valid
  WalkingTwist twist{};                  ///< limited
  CarriedBody body{};
  CarriedBody rates{};              ///< m/s, rad/s
  std::uint64_t gait = kStandGait;  ///< wanted; kStandGait ends the walk
};

/// The body as it is.
struct WalkingBody {
  Eigen::Matrix3d turned = Eigen::Matrix3d::Identity();  ///< base axes → level axes
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();    ///< m/s, of the base's origin, level axes
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();        ///< rad/s, level axes
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();      ///< m, centre of gravity, level axes
  Eigen::Vector3d moves = Eigen::Vector3d::Zero();       ///< m/s, of the centre of gravity, level axes
  double roll = 0, pitch = 0;                            ///< rad
  LegsValues angles{};                                   ///< rad
  LegsValues rates{};                                    ///< rad/s
  std::array<Eigen::Vector3d, kLegs> feet{};             ///< m, level axes
  std::array<Eigen::Matrix3d, kLegs> jacobians{};        ///< base axes
  LeggedEquations equations;
};

class Walker {
 public:
  static constexpr double kPlanTime = 0.01;  ///< s
  static constexpr std::uint64_t kFailures = 3;

  struct State {
    std::uint64_t gait = kStandGait;
    std::uint64_t last = kStandGait;  ///< the gait before
    double phase = 0;
    double lasted = 0;                          ///< s since this gait began
    std::array<std::uint64_t, kLegs> bears{};   ///< 1: its force is planned
    std::array<std::uint64_t, kLegs> swings{};  ///< 1: by the clock
    std::array<double, kLegs> touch_times{};    ///< s for which a contact is probable and it stays at its touch place
    std::array<Vector3, kLegs> touch_places{};  ///< m, level axes: where that began
    std::array<Vector3, kLegs> footprints{};    ///< m, level axes: where it bore last
    std::array<Vector3, kLegs> departs{};       ///< m, level axes: where its path through the air begins
    std::array<double, kLegs> departed{};       ///< 0 … 1, the part of the swing then
    std::array<Vector3, kLegs> forces{};        ///< N, level axes
    WalkingTwist follows{};                     ///< the twist with which the target moves
    std::array<double, 3> target{};             ///< m, m, rad, from the robot
    Vector3 ground{};                           ///< m: height of the ground below the base; its slopes
    std::uint64_t planned = 0;                  ///< cycles since the last plan
    std::uint64_t failures = 0;                 ///< plans without a solution, one after the other
  };

  /// Returns the cycles from plan to plan.
  static std::uint64_t plan_cycles(double period) noexcept {
    return std::max<std::uint64_t>(1, static_cast<std::uint64_t>(kPlanTime / period));
  }

  /// `friction` is μ of the forces, `period` s, `gaits` those of a leg of kReferenceLeg.
  Walker(const LegModel& robot, const Gaits& gaits, double friction, double period);

  /// Begins with all feet on the ground.
  void begin(State& state, const SensorFrame& sensors, const StateFrame& estimate) const noexcept;

  /// Fills joints, gait and stance of `out`, and adds to its reasons. Returns false if the plan has failed too often.
  bool step(State& state, const WalkInput& input, CommandFrame& out) noexcept;

  /// Returns the largest part 0 … 1 of the input's twist that keeps the feet in reach. The wanted gait may begin
  /// meanwhile.
  double reachable_part(const State& state, const WalkInput& input) const noexcept;

  /// The gaits of this robot.
  const Gaits& gaits() const noexcept { return gaits_; }

  WalkingBody measure(const SensorFrame& sensors, const StateFrame& estimate) const noexcept;

  /// Returns the distance in m of the foot that is farthest from its nominal place, along the ground.
  double farthest_foot(const WalkingBody& body) const noexcept;

 private:
  Eigen::Vector3d fit_ground(const State& state) const noexcept;
  void move(State& state, const WalkInput& input, const WalkingBody& body) const noexcept;
  /// Returns whether the wanted gait replaces this one if the phase wraps in `later` s.
  bool changes_after(const State& state, std::uint64_t wanted, double later) const noexcept;
  void begin_gait(State& state, std::uint64_t next) const noexcept;
  void turn_clock(State& state, std::uint64_t wanted) const noexcept;
  bool choose_feet(State& state, const WalkInput& input, const WalkingBody& body) const noexcept;
  Eigen::Vector3d landing(const State& state, const WalkInput& input, const WalkingBody& body,
                          std::size_t leg) const noexcept;
  /// Returns whether the clock lets a foot bear in `later` s.
  bool will_bear(const State& state, std::uint64_t wanted, std::size_t leg, double later) const noexcept;
  /// Returns for how many s a foot that bears still does by the clock.
  double bears_for(const State& state, std::uint64_t wanted, std::size_t leg) const noexcept;
  void plan(State& state, const WalkInput& input, const WalkingBody& body) noexcept;
  void bear(const State& state, const WalkingBody& body, std::size_t leg, CommandFrame& out) const noexcept;
  SwingPoint path(const State& state, const WalkInput& input, const WalkingBody& body, std::size_t leg) const noexcept;
  void lift_again(State& state, const WalkInput& input, const WalkingBody& body) const noexcept;
  void swing(const State& state, const WalkInput& input, const WalkingBody& body, std::size_t leg,
             CommandFrame& out) const noexcept;
  const Gait& gait(const State& state) const noexcept { return gaits_[state.gait]; }

  double period_;
  std::array<Leg, kLegs> legs_;
  LegDynamics dynamics_;
  LegTuning tuning_;
  LegsValues effort_limits_{};  ///< N·m
  Gaits gaits_;
  double length_;                                 ///< m, of a leg
  std::array<Eigen::Vector2d, kLegs> nominal_{};  ///< m, feet from the centre of gravity
  double height_ = 0;                             ///< m, of the centre of gravity above the ground
  ForcePlanParameters plan_parameters_;
  ForcePlan plan_;
};

}  // namespace robot_control
