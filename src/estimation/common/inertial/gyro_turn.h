#pragma once
/// Computes the angle by which the robot turned in each step by the gyro, also after a short silence of the gyro.
///
/// While the gyro is lost (imu_samples.h), the wheels turn the robot. If its samples return within kMaxHoldTime, the
/// line between the samples before and after replaces the turn by the wheels:
///
///   angle = (ω_before + ω_after)/2 · silence − b · (silence − dt) − turn by the wheels
///
/// The estimator subtracts b of the last step itself. So the gyro has turned the robot all the time.

#include <optional>
#include <utility>

#include "estimation/common/inertial/imu_samples.h"
#include "estimation/common/tuning.h"

namespace robot_control {

class GyroTurn {
 public:
  /// Returns the angle, bias included; empty: the wheels turn. `wheel_turn` is in rad, `bias` in rad/s, `dt` in s.
  std::optional<double> step(const ImuReading& imu, double wheel_turn, double bias, double dt) noexcept {
    const double before = std::exchange(sample_, imu.fresh_gyro ? imu.sample[2] : sample_);
    if (imu.gyro && silence_ == 0) return (*imu.gyro)[2] * dt;
    silence_ += dt;
    if (!imu.fresh_gyro) {
      wheel_turn_ += wheel_turn;
      return std::nullopt;
    }
    const double silence = std::exchange(silence_, 0);
    const double turned = std::exchange(wheel_turn_, 0);
    if (silence >= Tuning::kMaxHoldTime) return std::nullopt;
    return (before + sample_) / 2 * silence - bias * (silence - dt) - turned;
  }

 private:
  double sample_ = 0;      ///< rad/s, last sample
  double silence_ = 0;     ///< s since the gyro was lost
  double wheel_turn_ = 0;  ///< rad, turn by the wheels since the gyro was lost
};

}  // namespace robot_control
