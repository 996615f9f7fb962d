#pragma once
/// Does the robot stand? Judged by wheels and gyro alone, in windows one after another: a motor's hum shakes the
/// accelerometer of a robot that stands.
///
/// A window is quiet where no side travelled further than `tolerance` from where it was at its beginning (it ends at
/// once otherwise). Its gyro mean is that of a robot at rest where it is the known bias within `steady` and
/// kSignificant deviations; or, whatever it is, where it has been the same within `steady` for kConstantRate: nothing
/// turns a robot so evenly on wheels that stand. Where no rest has shown a bias yet, a body that swings after a stop
/// could read any: then each mean about z must have repeated the one before, within kSignificant deviations, for
/// kBlock.
///
/// The readings of wheels may be late, and a robot may begin to move before they say so: the means of a window count
/// when the next one is quiet, too.

#include <cstdint>
#include <optional>

#include "signals/geometry.h"

namespace robot_control {

struct RestWatchParams {
  double window = 0.25;        ///< s
  double tolerance = 0.00025;  ///< m
  double steady = 0.01;        ///< rad/s
  double turn_per_metre = 2;   ///< rad per m of right − left
};

/// Mean of samples over time.
class TimeMean {
 public:
  void reset() noexcept { *this = {}; }
  void add(const Vector3& value, double dt) noexcept {
    time_ += dt;
    for (std::size_t i = 0; i < 3; ++i) sum_[i] += value[i] * dt;
  }
  bool over(double window) const noexcept { return time_ >= window / 2; }  ///< known for half of it at least
  Vector3 mean() const noexcept { return {sum_[0] / time_, sum_[1] / time_, sum_[2] / time_}; }

 private:
  double time_ = 0;
  Vector3 sum_{};
};

enum class RestWindow : std::uint8_t {
  kOpen,    ///< not over
  kBroken,  ///< a wheel moved
  kTurned,  ///< over; the gyro reads another rate than its bias
  kQuiet,   ///< over; at rest
};

class RestWatch {
 public:
  RestWatch() = default;
  explicit RestWatch(const RestWatchParams& params) noexcept : params_(params) {}

  struct Sample {
    double dt = 0;
    const Vector3* gyro = nullptr;           ///< rad/s, base axes
    const Vector3* accelerometer = nullptr;  ///< m/s²
    double left = 0, right = 0;              ///< m, travel in this step
  };
  /// rad/s, of the gyro.
  struct Bias {
    Vector3 value{};
    Vector3 deviation{};  ///< of a window's mean from it; where it is not known, from another window's
    bool known = true;
  };
  RestWindow step(const Sample& sample, const Bias& bias) noexcept;

  void reset() noexcept;

  void discard() noexcept { pending_ = {}; }  ///< of the last window: the body still rocked

  double time() const noexcept { return done_.time; }  ///< s, of the window that counts
  const std::optional<Vector3>& gyro() const noexcept {
    return done_.gyro;
  }  ///< rad/s, its mean, less what the wheels turned
  const std::optional<Vector3>& force() const noexcept { return done_.force; }          ///< m/s²
  const std::optional<Vector3>& last_force() const noexcept { return pending_.force; }  ///< of the last window
  bool bias_changed() const noexcept { return bias_changed_; }  ///< the bias is another one than was known

 private:
  struct Window {
    double time = 0;
    std::optional<Vector3> gyro, force;
  };
  void begin() noexcept;
  RestWindow close(const Bias& bias) noexcept;

  RestWatchParams params_;
  double time_ = 0, left_ = 0, right_ = 0;
  TimeMean gyro_, force_;
  Window pending_;
  Window done_;
  Vector3 steady_gyro_{};
  double steady_time_ = 0, repeated_time_ = 0;
  bool bias_changed_ = false;
};

}  // namespace robot_control
