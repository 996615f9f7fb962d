#pragma once
/// The angle by which the robot turned in each step by the gyro, also through a short silence of the gyro.
///
/// While the gyro is lost (imu_samples.h) the wheels turn the robot. Where its samples come back within kLongestHold,
/// their straight line replaces what the wheels turned meanwhile:
///
///   angle = (ω_before + ω_after)/2 · silence − b · (silence − dt) − turn by the wheels
///
/// so that, behind the bias b of the step itself, the gyro has turned the robot all the time.

#include <optional>
#include <utility>

#include "estimation/inertial/imu_samples.h"
#include "estimation/tuning.h"

namespace robot_control {

class GyroTurn {
 public:
  /// rad, bias included; empty: by the wheels. `wheel_turn`: rad, of this step, `bias`: rad/s, `dt`: s.
  std::optional<double> step(const ImuSamples& imu, double wheel_turn, double bias, double dt) noexcept {
    const bool fresh = imu.new_gyro();
    const double before = std::exchange(sample_, fresh ? imu.last_gyro().z() : sample_);
    if (imu.gyro() && silence_ == 0) return imu.gyro()->z() * dt;
    silence_ += dt;
    if (!fresh) {
      wheel_turn_ += wheel_turn;
      return std::nullopt;
    }
    const double silence = std::exchange(silence_, 0);
    const double turned = std::exchange(wheel_turn_, 0);
    if (silence >= Tuning::kLongestHold) return std::nullopt;
    return (before + sample_) / 2 * silence - bias * (silence - dt) - turned;
  }

  bool silent() const noexcept { return silence_ > 0; }

 private:
  double sample_ = 0;      ///< rad/s, the last one
  double silence_ = 0;     ///< s, since the gyro was lost
  double wheel_turn_ = 0;  ///< rad, since then
};

}  // namespace robot_control
