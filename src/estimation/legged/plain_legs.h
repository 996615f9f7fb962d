#pragma once
/// The plain estimate of a body on legs, beside which the filter must do no harm.
///
/// attitude   the gyro, less its bias, turns it; the accelerometer corrects roll and pitch with kTilt, while |a| is
/// about
///            g. Yaw is that of the gyro alone
/// bias       the mean of the gyro while nothing moves
/// velocity   the mean over the feet that stand of r ωᵢ × u − (Jᵢ q̇ᵢ + ω × pᵢ), through a low pass of kSmooth. While
///            none does, it stays where feet are asked to bear, and is zero otherwise
/// position   the sum of velocities

#include <array>

#include "estimation/legged/feet_motion.h"
#include "signals/geometry.h"

namespace robot_control {

class PlainLegs {
 public:
  static constexpr double kTilt = 1.5;        ///< s
  static constexpr double kTiltAtRest = 0.3;  ///< s
  static constexpr double kBand = 1.0;        ///< m/s², of |a| about g within which the accelerometer corrects
  static constexpr double kBiasTime = 0.5;    ///< s
  static constexpr double kSmooth = 0.02;     ///< s

  struct State {
    std::array<double, 4> attitude{0, 0, 0, 1};  ///< x y z w, base → odom
    Vector3 bias{};                              ///< rad/s, base axes
    Vector3 velocity{};                          ///< m/s, of the base's origin, base axes
    Vector3 position{};                          ///< m
  };

  struct Input {
    Eigen::Vector3d rate, force;  ///< rad/s, m/s², as measured, base axes
    bool at_rest = false;
    bool asked = false;  ///< feet are asked to bear
    double dt = 0;       ///< s
  };
  static void turn(const Input& input, State& state) noexcept;
  static void move(const Input& input, const FeetMotion& feet, const std::array<bool, kLegs>& stand,
                   State& state) noexcept;
};

}  // namespace robot_control
