#pragma once
/// Does the robot stand, and what do gyro and accelerometer read then? Looks at windows of fixed length, one after
/// another.
///
/// A window is quiet when, over its whole length T,
///   wheels          stayed within ± tolerance of where they were at its beginning (a window ends at once otherwise)
///   accelerometer   RMS deviation from its mean ≤ acceleration; not asked where there is none
/// Whether the means are those of a robot at rest, the caller judges.

#include <Eigen/Core>
#include <cstdint>
#include <optional>

namespace robot_control {

struct StandstillLimits {
  double time = 0.25;          ///< s, T
  double tolerance = 0.00025;  ///< m, of a wheel's travel
  double acceleration = 0.3;   ///< m/s²
};

struct StandstillSample {
  double dt = 0;                                 ///< s since the last sample
  double left = 0, right = 0;                    ///< m, travel over dt
  std::optional<Eigen::Vector3d> gyro;           ///< rad/s
  std::optional<Eigen::Vector3d> accelerometer;  ///< m/s²
};

enum class WindowEnd : std::uint8_t {
  kOpen,    ///< the window is not over
  kBroken,  ///< a wheel moved: a new window begins
  kShaken,  ///< the window is over, the accelerometer was not quiet
  kQuiet,   ///< the window is over: the means are valid until the next step
};

class StandstillWindow {
 public:
  explicit StandstillWindow(const StandstillLimits& limits) noexcept : limits_(limits) {}

  /// A new window begins.
  void reset() noexcept;

  WindowEnd step(const StandstillSample& sample) noexcept;

  /// Of the last window that was over; empty where a sample of the kind never came in it.
  const std::optional<Eigen::Vector3d>& gyro() const noexcept { return gyro_mean_; }                    ///< rad/s
  const std::optional<Eigen::Vector3d>& accelerometer() const noexcept { return accelerometer_mean_; }  ///< m/s²
  double time() const noexcept { return time_done_; }                                                   ///< s
  double left() const noexcept { return left_done_; }    ///< m, travel in the last complete window
  double right() const noexcept { return right_done_; }  ///< m

 private:
  /// Sums of deviations from the window's first sample: small numbers keep their digits.
  struct Sum {
    std::uint64_t count = 0;
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();
    Eigen::Vector3d deviations = Eigen::Vector3d::Zero();
    double squares = 0;

    void add(const Eigen::Vector3d& sample) noexcept;
    double variance() const noexcept;
    std::optional<Eigen::Vector3d> mean() const noexcept;
  };

  StandstillLimits limits_;
  double time_ = 0;
  double left_ = 0, right_ = 0;
  Sum gyro_;
  Sum accelerometer_;
  double time_done_ = 0;
  double left_done_ = 0, right_done_ = 0;
  std::optional<Eigen::Vector3d> gyro_mean_;
  std::optional<Eigen::Vector3d> accelerometer_mean_;
};

}  // namespace robot_control
