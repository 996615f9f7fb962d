#pragma once
/// How the feet stand, while the command says that the robot stands. The foot in the air, or on its way, is left out.
///
///   foot slip  max over pairs of standing feet of |d(t) − d(t − T)| / T > limit, T = kWindow. d is the distance of two
///              feet by the measured angles. It stays while both stand, however the body moves, and changes by the
///              slip. Feet that slip together are not noticed. A ball that rolls changes d by less than its radius
///              times the body's turn
///   foot load  F·u / w < limit, with the measured force F of a foot, the vertical u and an equal share w of the weight
///
/// Without contact sensors the load is not known and not evaluated. Each condition names the knee of the worst foot.

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

  /// `period` s.
  FootConditions(const SafetyParameters& parameters, const LegModel& robot, double period);

  void enter_run() noexcept;
  /// `up` is the vertical in base axes, by gravity.
  void step(const MonitorInput& input, const Eigen::Vector3d& up, std::uint64_t elapsed, ActiveCauses& out) noexcept;

 private:
  static constexpr std::size_t kPairs = kLegs * (kLegs - 1) / 2;
  using Distances = std::array<double, kPairs>;  ///< m

  void sample(const SensorFrame& sensors, std::uint64_t lifted) noexcept;
  void compare(const Distances& now, std::uint64_t lifted) noexcept;
  ConditionMeasurement lightest(const SensorFrame& sensors, const Eigen::Vector3d& up,
                                std::uint64_t lifted) const noexcept;

  /// The numbers of a LegGeometry, which is not trivially copyable.
  struct Lengths {
    Vector3 hip{}, upper{}, lower{}, foot{};  ///< m
    std::array<double, kLegJoints> sign{};
  };
  static Eigen::Vector3d position(const Lengths& leg, const LegAngles& angles) noexcept;

  std::array<Lengths, kLegs> legs_{};
  double weight_;           ///< N
  std::uint64_t interval_;  ///< cycles between two samples of the distances
  double window_;           ///< s
  ConditionWatch slip_, load_;
  std::array<Distances, kSamplesInWindow> samples_{};
  std::size_t count_ = 0;         ///< samples since the feet stand
  std::uint64_t waited_ = 0;      ///< cycles since the last sample
  std::uint64_t lifted_ = 0;      ///< 1 + leg of the foot that is left out; 0: none
  ConditionMeasurement worst_{};  ///< slip of the last sample
};

}  // namespace robot_control
