#pragma once
/// How the feet stand, while the command says that the robot stands or walks. Feet in the air, or on their way, are
/// left out. While it walks, a foot is judged after kEdge of its stance, and its slip with kStepShare of the limit.
///
///   foot slip  |Δd| / kWindow > limit, max over pairs of standing feet
///   body turn  (max(|c·u|, kYawShare |h|) − kSlipFactor |Δd| − kUnevenShare e) / |v| > limit, max over these pairs
///   foot load  F·u / w < limit
///   sinking    (c − c₀ − (h − h₀) − e) / l > limit
///
/// foot slip: d is the distance of two feet by the measured angles, and Δd its change within kWindow.
///
/// body turn, while it walks: v is the vector from foot to foot, θ the turn of the gyro, and c = Δv + θ × v. u is the
/// vertical, and h the part of c across v and u. c is 0 over ground that rests, if the gyro is right. The change is
/// that within kWindow, or since both stand, but within kFewestSamples at least. The last kEdge of both stances is left
/// out, and kWindow after the driver braked.
///
/// While the body is pushed (body_motion.h), a robot that walks slides and catches itself: neither is measured.
///
/// Each of these changes continues. It is the smaller of that within its time, and that within the second half of this
/// time, scaled to the whole. A foot that lands late moves once, and then rests.
///
/// foot load: F is the measured force of a foot, w an equal share of the weight. While it walks, the load of a foot is
/// the largest of its present or last step. Without contact sensors it is not evaluated.
///
/// sinking, while it walks: h is the height of the body above its lowest foot, along n, by the measured angles. The
/// commanded height is c, and the leg length l. h₀ and c₀ are those of the robot that stood. A foot lands at a distance
/// e from the plane of the others, which fades within kUnevenTime. The body rises onto a step after its feet.
///
/// A foot in stance goes down from the body by at most kReaching leg lengths per second. A faster one has not met the
/// ground yet, and its stance begins again.
///
/// The ground's normal n is fixed in the world (fixed_direction.h). On its feet, the robot measures it across the
/// diagonals of the places where its feet bore last, with the time constant kGroundTime. A robot that falls over turns
/// these places with it: nothing is measured while the body turns by more than kMaxTurn. Before each foot has borne,
/// and off its feet, n is the vertical.
///
/// Slip and load name the knee of the worst foot. The reasons: docs/evidence/derivations.md.

#include <array>
#include <cstddef>
#include <cstdint>

#include "machine/legs/leg_model.h"
#include "machine/stored.h"
#include "safety/conditions/common/condition_list.h"
#include "safety/measurements/body_motion.h"
#include "safety/measurements/fixed_direction.h"
#include "safety/monitor_input.h"

namespace robot_control {

/// In the units of their causes.
struct FootMeasurements {
  ConditionMeasurement foot_slip = kNothingMeasured;
  ConditionMeasurement foot_load = kNothingMeasured;
  ConditionMeasurement sinking = kNothingMeasured;
  ConditionMeasurement body_turn = kNothingMeasured;
};

class StandingFeet {
 public:
  static constexpr double kWindow = 0.1;  ///< s
  static constexpr std::size_t kSamplesInWindow = 10;
  static constexpr std::size_t kFewestSamples = 3;  ///< of at least kWindow / kSamplesInWindow each
  static constexpr double kSlipFactor = 2;          ///< docs/evidence/legs.md
  static constexpr double kYawShare = 0.5;          ///< docs/evidence/legs.md
  static constexpr double kEdge = 0.15;
  static constexpr double kStepShare = 0.55;   ///< docs/evidence/derivations.md
  static constexpr double kReaching = 1.2;     ///< 1/s; free feet are faster, those of a body that tips slower
  static constexpr double kUnevenShare = 0.1;  ///< a foot on an edge rolls about it
  static constexpr double kUnevenTime = 0.5;   ///< s, in which the body rises onto a step
  static constexpr double kGroundTime = 1.0;   ///< s, some steps
  static constexpr double kMaxTurn = 0.5;      ///< rad/s

  /// `period` s.
  StandingFeet(const SafetyParameters& parameters, const LegModel& robot, double period);

  void enter_run() noexcept;
  FootMeasurements step(const MonitorInput& input, const BodyMotion& body, std::uint64_t elapsed) noexcept;

  /// n, after `step`.
  const FixedDirection& ground() const noexcept { return ground_; }

 private:
  using Feet = std::array<bool, kLegs>;
  struct Sample {
    std::array<Stored<Eigen::Vector3d>, kLegs> feet{};  ///< m, base axes
    Stored<Eigen::Vector3d> turn{};                     ///< rad, of the gyro since the sample before
  };

  void sample(const SensorFrame& sensors, const CommandFrame& command, const Eigen::Vector3d& up, const Feet& bears,
              const Feet& judged, double dt) noexcept;
  /// Each foot has borne: there is a plane.
  bool placed() const noexcept { return placed_ == Feet{true, true, true, true}; }
  void follow_ground(const Sample& now, const Feet& bears, bool walks, double dt) noexcept;
  void compare(const Sample& now, const CommandFrame& command, const Eigen::Vector3d& up) noexcept;
  ConditionMeasurement lightest(const SensorFrame& sensors, const Eigen::Vector3d& up, const Feet& judged, double share,
                                bool walks) noexcept;

  /// The numbers of a LegGeometry, which is not trivially copyable.
  struct Lengths {
    Stored<Eigen::Vector3d> hip, upper, lower, foot;  ///< m
    std::array<double, kLegJoints> sign{};
  };
  static Eigen::Vector3d position(const Lengths& leg, const LegAngles& angles) noexcept;

  std::array<Lengths, kLegs> legs_{};
  double period_;           ///< s
  double weight_;           ///< N
  std::uint64_t interval_;  ///< cycles between two samples
  double window_;           ///< s
  double slip_limit_, load_limit_, sinking_limit_, turn_limit_;
  double length_;  ///< m, of a leg
  std::array<Sample, kSamplesInWindow> samples_{};
  std::size_t next_ = 0;                     ///< index of the oldest sample
  std::array<std::size_t, kLegs> counts_{};  ///< samples since the foot stands
  std::uint64_t waited_ = 0;                 ///< cycles since the last sample
  Sample since_{};                           ///< then; without feet
  std::array<double, kLegs> loads_{};        ///< of a share, of the feet when they were judged last
  Feet judged_{};                            ///< in the last cycle
  double unbraked_ = 0;                      ///< s since the driver braked
  bool stood_ = false;                       ///< reference_ is known
  double reference_ = 0;                     ///< m, height of the body less the commanded one, when it stood last
  FootMeasurements measured_;                ///< of the last sample
  FixedDirection ground_;
  std::array<Stored<Eigen::Vector3d>, kLegs> places_{};  ///< m, base axes: where the feet bore last
  Feet placed_{};                                        ///< their place is known
  Feet bore_{};                                          ///< in the last sample
  double uneven_ = 0;                                    ///< m, e
};

}  // namespace robot_control
