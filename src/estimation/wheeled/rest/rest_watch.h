#pragma once
/// The rest watch decides whether the robot stands. It uses wheels and gyro alone, in successive windows, because a
/// motor's hum shakes the accelerometer of a standing robot.
///
/// A window is quiet if no side travels further than `tolerance` from its place at the beginning; otherwise the window
/// ends at once. The gyro's mean of a quiet window belongs to a robot at rest in each of these cases:
///   - it equals the known bias within `steady` and kSignificant deviations;
///   - it has stayed the same within `steady` for kConstantRate: nothing turns a robot so evenly on standing wheels;
///   - no bias is known yet, and each mean about z has repeated the one before, within kSignificant deviations, for
///     kBlock.
/// The third rule excludes a body that swings after a stop.
///
/// Readings of the wheels may be late, so that the robot may move before they show it. Therefore the means of a window
/// count only when the next one is quiet, too, or lasts longer than readings are late.

#include <cstdint>
#include <optional>

#include "signals/geometry.h"

namespace robot_control {

struct RestWatchParams {
  double window = 0.25;        ///< s
  double tolerance = 0.00025;  ///< m
  double steady = 0.01;        ///< rad/s
  double turn_per_metre = 2;   ///< rad per m of right minus left
};

/// Computes the mean of samples over time.
class TimeMean {
 public:
  void reset() noexcept { *this = {}; }
  void add(const Vector3& value, double dt) noexcept {
    time_ += dt;
    for (std::size_t i = 0; i < 3; ++i) sum_[i] += value[i] * dt;
  }
  bool over(double window) const noexcept { return time_ >= window / 2; }  ///< The samples cover half the window.
  Vector3 mean() const noexcept { return {sum_[0] / time_, sum_[1] / time_, sum_[2] / time_}; }

 private:
  double time_ = 0;
  Vector3 sum_{};
};

enum class RestWindow : std::uint8_t {
  kOpen,    ///< The window is not over.
  kBroken,  ///< A wheel moved.
  kTurned,  ///< The window is over; the gyro reads another rate than its bias.
  kQuiet,   ///< The window is over; the robot is at rest.
};

class RestWatch {
 public:
  RestWatch() = default;
  explicit RestWatch(const RestWatchParams& params) noexcept : params_(params) {}

  struct Sample {
    double dt = 0;
    double left = 0, right = 0;              ///< m, travel in this step
    std::optional<Vector3> gyro{};           ///< rad/s, base axes
    std::optional<Vector3> accelerometer{};  ///< m/s²
  };
  /// Describes the bias of the gyro, in rad/s.
  struct Bias {
    Vector3 value{};
    Vector3 deviation{};  ///< between a window's mean and the bias, or two means if it is unknown
    bool known = true;
  };
  /// Holds the means over a quiet window.
  struct Means {
    double time = 0;                         ///< s, length of the window
    std::optional<Vector3> gyro{};           ///< rad/s, minus the turn of the wheels
    std::optional<Vector3> accelerometer{};  ///< m/s²
  };
  RestWindow step(const Sample& sample, const Bias& bias) noexcept;

  void reset() noexcept;

  void discard() noexcept { pending_ = {}; }  ///< discards the last window, in which the body still rocked

  const Means& means() const noexcept { return done_; }  ///< those of the window that counts
  /// Returns true if the last window shows another bias of the gyro than the known one.
  bool bias_changed() const noexcept { return bias_changed_; }
  /// Returns true if a wheel moved so late in the last window that the one before counts.
  bool confirmed() const noexcept { return confirmed_; }

 private:
  void begin() noexcept;
  RestWindow close(const Bias& bias) noexcept;

  RestWatchParams params_;
  double time_ = 0, left_ = 0, right_ = 0;
  TimeMean gyro_, force_;
  Means pending_;
  Means done_;
  Vector3 steady_gyro_{};
  double steady_time_ = 0, repeated_time_ = 0;
  bool bias_changed_ = false;
  bool confirmed_ = false;
};

}  // namespace robot_control
