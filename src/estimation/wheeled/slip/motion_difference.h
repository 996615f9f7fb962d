#pragma once
/// Computes the motion by wheels and gyro minus the motion by the accelerometer. It does not depend on the state of a
/// filter.
///
///   E(t) = path by wheels and gyro + (lever of the IMU − ∬ acceleration dt²)(t − τ)   path_difference: m, odom axes
///   W(t) = right − left − B ψ(t − τ)                                                  turn_difference: m
///
/// The path is that of the middle of the wheels. The acceleration is the IMU's without gravity. The lever leads from
/// the middle of the wheels to the IMU and turns with the yaw ψ of the gyro. B is the wheel base. τ is the clock
/// offset. A reading of the wheels with the stamp t shows the state at t − τ (planar/planar_core.h).
///
/// While no wheel slips, E is a straight line, whose slope is the unknown speed at the beginning, and W is constant.
/// Time begins at 0 at the end of a rest and after a restart.
///
/// τ is learned in motion. Therefore the points keep both motions, and every difference uses the present τ. The
/// inertial motion between two points is that of a constant acceleration. If τ < 0, the wheels are early: a point is
/// known when t − τ has passed. So both motions are not compared over an interruption of the points.

#include <array>
#include <cstddef>

#include "estimation/common/tuning.h"
#include "estimation/common/values.h"

namespace robot_control {

struct SlipParams {
  double encoder = 4.4e-5;         ///< m, of one reading
  double accelerometer = 1.7e-3;   ///< m/s²/√Hz
  double wheel_base = 0.5;         ///< m
  double wheel_slip_noise = 8e-5;  ///< m/√m
  double imu_x = 0, imu_y = 0;     ///< m, base axes, of the IMU from the middle of the wheels
  double imu_above_ground = 0;     ///< m
};

class MotionDifference {
 public:
  struct Point {
    double time = 0;             ///< s, stamp of the wheels
    Planar path_difference{};    ///< m, odom axes: E
    double turn_difference = 0;  ///< m: W
    double distance = 0;         ///< m, always growing
    double yaw = 0;              ///< rad, at time − τ as all members below
    Planar velocity{};           ///< m/s, odom axes: integral of the acceleration since the restart
    double yaw_rate = 0;         ///< rad/s
  };

  /// Describes the motion of one step.
  struct Sample {
    double dt = 0;                         ///< s
    std::array<double, 2> acceleration{};  ///< m/s², base axes, without gravity
    Vector3 up{0, 0, 1};                   ///< base axes
    double turned = 0;                     ///< rad, by the gyro
    double yaw = 0;                        ///< rad, at the end of the step
    Planar path{};                         ///< m, odom axes, by wheels and gyro
    double right_minus_left = 0;           ///< m, by the calibration scaled to the nominal B
    double distance = 0;                   ///< m, (|left| + |right|)/2
    bool both_sides_read = false;          ///< The travel of both sides was read in this step.
    double yaw_rate = 0;                   ///< rad/s
  };

  explicit MotionDifference(const SlipParams& params) noexcept : params_(params) {}

  void restart() noexcept;  ///< removes all points
  /// Continues after a slide: the past is laid on a line of E with that slope (m/s, odom axes) and a constant W.
  void restart_on_line(const Planar& slope) noexcept;
  /// Restarts at the end of a rest. `velocity` (m/s, odom axes) is the acceleration integrated since then.
  void restart_at_rest(double yaw, const Vector3& up, const Planar& velocity) noexcept;
  /// States that the pose was set: the path before is not corrected any more.
  void begin_path() noexcept { path_begin_ = time(); }
  double path_begin() const noexcept { return path_begin_; }  ///< s
  /// Sets τ, s. It must not change during a slide, which keeps differences.
  void set_clock_offset(double offset) noexcept { clock_offset_ = offset; }

  /// Returns true if a point was added.
  bool step(const Sample& sample) noexcept;

  double time() const noexcept { return now_.time; }  ///< s, of the last step
  bool empty() const noexcept { return count_ == 0; }
  bool interrupted() const noexcept { return !empty() && time() - record(count_ - 1).time > Tuning::kResidualSpans[1]; }
  Point last() const noexcept { return before(time()); }  ///< the newest point that is known; there must be one
  Point before(double time) const noexcept;               ///< the newest known point that is not later, else the oldest

 private:
  static constexpr std::size_t kPoints = 64;

  /// Holds both motions until `time`.
  struct Record {
    double time = 0;               ///< s
    Planar wheel_path{};           ///< m, odom axes
    double right_minus_left = 0;   ///< m
    double distance = 0;           ///< m
    Planar inertial{};             ///< m, odom axes: lever − ∬ acceleration dt²
    Planar velocity{};             ///< m/s, odom axes: ∫ acceleration dt since the restart
    double yaw = 0, yaw_rate = 0;  ///< rad, rad/s
  };

  Planar lever(double yaw, const Vector3& up) const noexcept;
  Record& record(std::size_t i) noexcept { return records_[i % kPoints]; }
  const Record& record(std::size_t i) const noexcept { return records_[i % kPoints]; }
  std::size_t oldest() const noexcept { return count_ > kPoints ? count_ - kPoints : 0; }
  std::size_t index_before(double time) const noexcept;  ///< newest record that is not later, else the oldest
  Point difference(const Record& wheels) const noexcept;

  SlipParams params_;
  std::array<Record, kPoints> records_{};  ///< ring, at least Tuning::kPointInterval apart
  std::size_t count_ = 0;
  Record now_;
  Planar lever_;  ///< m, odom axes, at the end of the last step
  double clock_offset_ = 0;
  double path_begin_ = 0;
};

}  // namespace robot_control
