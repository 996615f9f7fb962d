#pragma once
/// Does the robot stand, and what does the gyro read then? Looks at windows of fixed length, one after another.
///
/// A window is quiet when, over its whole length T,
///   wheels          stayed within ± tolerance of where they were at its beginning (a window ends at once otherwise)
///   gyro            |mean yaw rate − bias| ≤ yaw_rate
///   accelerometer   RMS deviation from its mean ≤ acceleration; not asked where there is none
/// `standing` holds from the end of a quiet window to the end of one that is not. The mean rate of a quiet
/// window, less what the wheels turned in it, is a measurement of the gyro's bias.

#include <cstdint>

#include "signals/geometry.h"

namespace robot_control {

struct StandstillLimits {
  std::uint64_t cycles = 250;  ///< T in cycles
  double tolerance = 0.00025;  ///< m, of a wheel's travel
  double acceleration = 0.3;   ///< m/s²
};

struct StandstillSample {
  double left = 0, right = 0;  ///< m, travel since the last sample
  std::uint64_t cycles = 0;    ///< since the last sample
  Vector3 angular_velocity{};  ///< rad/s, IMU axes
  bool accelerometer = false;
  Vector3 linear_acceleration{};  ///< m/s², IMU axes
};

class StandstillWindow {
 public:
  explicit StandstillWindow(const StandstillLimits& limits) noexcept : limits_(limits) {}

  /// A sample was missing: nothing is known.
  void reset() noexcept;

  /// True when a window is complete and its wheels and accelerometer were quiet: the gyro's mean is to be judged
  /// with `judge`, in the same cycle.
  bool step(const StandstillSample& sample) noexcept;

  /// The gyro was quiet in the window that ended.
  void judge(bool gyro_quiet) noexcept { standing_ = gyro_quiet; }

  bool standing() const noexcept { return standing_; }
  const Vector3& mean_angular_velocity() const noexcept { return mean_; }  ///< of the last complete window
  std::uint64_t cycles() const noexcept { return cycles_done_; }           ///< length of the last complete window
  double left() const noexcept { return left_done_; }                      ///< m, travel in the last complete window
  double right() const noexcept { return right_done_; }                    ///< m

 private:
  void begin() noexcept;

  StandstillLimits limits_;
  bool standing_ = false;
  std::uint64_t cycles_ = 0;
  std::uint64_t cycles_done_ = 0;
  std::uint64_t samples_ = 0;
  double left_ = 0, right_ = 0;
  double left_done_ = 0, right_done_ = 0;
  Vector3 rate_sum_{};
  std::uint64_t accelerations_ = 0;
  Vector3 acceleration_origin_{};  ///< first sample of the window: sums of small numbers keep their digits
  Vector3 acceleration_sum_{};
  double acceleration_squares_ = 0;
  Vector3 mean_{};
};

}  // namespace robot_control
