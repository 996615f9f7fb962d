#pragma once
/// Estimates what each foot bears, and whether it bears.
///
/// load   fᵢ = u·Fᵢ, u upwards, F the measured force where all feet have force sensors. Else F follows from the joints'
///        efforts. With the needed efforts M a + h of a leg in the air, and the low pass L of kObserverTime,
///
///          Fᵢ = Jᵢ⁻ᵀ (M a + h − L τ)ᵢ,    q̈ = (q̇ − L q̇)/kObserverTime, and the same of ω;   Rᵀp̈ − g = L (specific force)
///
///        (q̇ − L q̇)/kObserverTime is L of the derivative. So this is the observer of the legs' momentum for legs whose mass
///        matrix hardly changes within kObserverTime (A. De Luca, R. Mattone, ICRA 2005).
/// bears  the probability pᵢ of a contact, with the share of the load x = fᵢ/(m g/4):
///
///          p = ½ + (x − bound)/kBlur within 0 … 1
///
///        The bound is kAsked where the command asked the foot to bear, kSwings where it asked others alone, and
///        kNotAsked where it asked none. While others are asked to, a foot that no longer is does not bear for kLift,
///        because its load ends in the low pass alone.
///
/// kObserverTime follows from encoders of 4096 counts per turn, whose speed has steps of 1.5 rad/s.

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "estimation/legged/feet_motion.h"
#include "machine/legs/leg_dynamics.h"
#include "signals/sensor_frame.h"

namespace robot_control {

/// Returns whether any foot was asked to bear.
bool feet_asked(const SensorFrame& sensors) noexcept;

class FootContacts {
 public:
  static constexpr double kObserverTime = 0.012;  ///< s
  static constexpr double kLift = 0.04;           ///< s
  static constexpr double kAsked = 0.15;
  static constexpr double kNotAsked = 0.35;
  static constexpr double kSwings = 0.8;
  static constexpr double kBlur = 0.2;

  struct State {
    LegsValues rates{}, efforts{};      ///< rad/s, N·m: low passes
    Vector3 angular{}, force{};         ///< rad/s, m/s²: low passes of gyro and accelerometer
    std::array<double, kLegs> loads{};  ///< N
    std::array<double, kLegs> probability{};
    std::array<double, kLegs> lifted{};  ///< s for which others, and not this foot, are asked to bear
    std::uint64_t begun = 0;             ///< 1: the low passes have begun
  };

  explicit FootContacts(const LegModel& robot);

  /// Whether the foot of this probability bears.
  static bool bears(double probability) noexcept { return probability > 0.5; }

  /// `rate` in rad/s and `force` in m/s², the specific force, are those of the base in its axes.
  void step(const SensorFrame& sensors, const FeetMotion& feet, const Eigen::Vector3d& rate,
            const Eigen::Vector3d& force, const Eigen::Vector3d& up, double dt, State& state) const noexcept;

 private:
  LegDynamics dynamics_;
  double share_;  ///< N, an equal share of the weight
};

}  // namespace robot_control
