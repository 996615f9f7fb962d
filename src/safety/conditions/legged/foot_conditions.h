#pragma once
/// How the feet stand, while the command says that the robot stands or walks. Feet in the air, or on their way, are
/// left out. While it walks, a foot is judged after kEdge of its stance, and its slip with kOfStep of the limit.
///
///   foot slip  max over pairs of standing feet of |Δd| / kWindow > limit. d is the distance of two feet by the measured
///              angles, and Δd its change within kWindow. d stays while both stand, however the body moves, and changes
///              by the slip. Feet that slip together are not noticed. A ball that rolls changes d by less than its radius
///              times the body's turn
///   body turn  max over these pairs of (max(|c·u|, kOfYaw |h|) − kOfSlip |Δd|) / |v| > limit, while it walks, before the
///              last kEdge of both stances, and kWindow after the driver braked. v is the vector from foot to foot, and
///              c = Δv + θ × v its change, in which the gyro turned by θ. It is judged within kWindow, or since both
///              stand, but kFewestSamples at least. c is 0 over ground that rests, if the gyro is right. u is the
///              vertical. h is the part of c across v and u: the feet creep where the robot turns about u. An encoder
///              that errs changes d, too. A foot above a hole does not
///   foot load  F·u / w < limit, with the measured force F of a foot, the vertical u and an equal share w of the weight
///   sinking    (c − c₀ − (h − h₀)) / l > limit, while it walks. h is the mean height of the body above its feet by the
///              measured angles, c the commanded height, l the leg length. h₀ and c₀ are those of the robot that stood
///
/// While it walks, the load of a foot is the largest of its present or last step. So a foot that bears in none of its
/// steps is found, and one that leaves the ground a little early is not. Without contact sensors the load is not known
/// and not evaluated. Slip and load name the knee of the worst foot.

#include <array>
#include <cstddef>
#include <cstdint>

#include "machine/legs/leg_model.h"
#include "safety/conditions/common/condition_watch.h"
#include "safety/latch/active_causes.h"
#include "safety/monitor_input.h"
#include "safety/safety_parameters.h"

namespace robot_control {

/// Returns limits with a limit of foot_slip, where none is given: one leg length per second.
SafetyParameters legged_limits(const SafetyParameters& given, const LegModel& robot);

class FootConditions {
 public:
  static constexpr double kWindow = 0.1;  ///< s
  static constexpr std::size_t kSamplesInWindow = 10;
  static constexpr std::size_t kFewestSamples = 3;  ///< of at least kWindow / kSamplesInWindow each
  static constexpr double kOfSlip = 2;              ///< docs/evidence/legs.md
  static constexpr double kOfYaw = 0.5;             ///< docs/evidence/legs.md
  static constexpr double kEdge = 0.15;
  static constexpr double kOfStep = 0.55;  ///< docs/evidence/derivations.md

  /// `period` s.
  FootConditions(const SafetyParameters& parameters, const LegModel& robot, double period);

  void enter_run() noexcept;
  /// `up` is the vertical in base axes, by gravity; `rate` that of the gyro in rad/s, base axes, NaN without one.
  void step(const MonitorInput& input, const Eigen::Vector3d& up, const Eigen::Vector3d& rate, std::uint64_t elapsed,
            ActiveCauses& out) noexcept;

 private:
  using Feet = std::array<bool, kLegs>;
  struct Sample {
    std::array<Vector3, kLegs> feet{};  ///< m, base axes
    Vector3 turn{};                     ///< rad, of the gyro since the sample before
  };

  void sample(const SensorFrame& sensors, const CommandFrame& asked, const Eigen::Vector3d& up,
              const Feet& judged) noexcept;
  void compare(const Sample& now, const CommandFrame& asked, const Eigen::Vector3d& up) noexcept;
  ConditionMeasurement lightest(const SensorFrame& sensors, const Eigen::Vector3d& up, const Feet& judged, double share,
                                bool walks) noexcept;

  /// The numbers of a LegGeometry, which is not trivially copyable.
  struct Lengths {
    Vector3 hip{}, upper{}, lower{}, foot{};  ///< m
    std::array<double, kLegJoints> sign{};
  };
  static Eigen::Vector3d position(const Lengths& leg, const LegAngles& angles) noexcept;

  std::array<Lengths, kLegs> legs_{};
  double weight_;           ///< N
  double period_;           ///< s
  std::uint64_t interval_;  ///< cycles between two samples
  double window_;           ///< s
  ConditionWatch slip_, load_, sinking_, turning_;
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
  ConditionMeasurement slipped_{}, sunk_{}, turned_{};  ///< of the last sample
};

}  // namespace robot_control
