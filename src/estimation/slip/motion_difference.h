#pragma once
/// The motion by wheels and gyro minus the motion by the accelerometer, without the state of a filter.
///
///   E(t) = path by wheels and gyro + (lever of the IMU − ∬ acceleration dt²)(t − τ)   path_difference: m, odom axes
///   W(t) = right − left − B ψ(t − τ)                                                  turn_difference: m
///
/// The path is that of the middle of the wheels; the acceleration is the IMU's, gravity removed; the lever leads from
/// the middle of the wheels to the IMU and turns with the yaw ψ, which is the gyro's; B is the wheel base. τ is the
/// clock offset: what wheels report with the stamp t was so at t − τ (planar/planar_core.h), and both are compared at
/// the same moment. Compared at the same stamp, E contained −τ times the velocity, and whenever that changes by Δv the
/// robot would seem to slip by τ Δv. While no wheel slips E is a straight line, whose slope is the speed at the
/// beginning, which the integral does not contain, and W is a constant. Time begins at 0 when the robot was at rest and
/// when there is no past.
///
/// τ is learned in motion, so the points keep the two motions, and every difference is formed by the present τ: none
/// compares two values of τ. Between two points the inertial motion is interpolated. Where the wheels are early, τ < 0,
/// the last point is the last one for which t − τ has passed: what the IMU will report is not known. Such a
/// point is judged when the next one is added.

#include <array>
#include <cstddef>

#include "estimation/slip/inertial_motion.h"
#include "estimation/tuning.h"
#include "estimation/values.h"

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
    double yaw = 0;              ///< rad, like all that follows at time − τ
    Planar velocity{};           ///< m/s, odom axes: integral of the acceleration since the restart
    double yaw_rate = 0;         ///< rad/s
  };

  /// What happened in one step.
  struct Sample {
    double dt = 0;                         ///< s
    std::array<double, 2> acceleration{};  ///< m/s², base axes, without gravity
    Vector3 up{0, 0, 1};                   ///< base axes
    double turned = 0;                     ///< rad, by the gyro
    double yaw = 0;                        ///< rad, at the end of the step
    Planar path{};                         ///< m, odom axes, by wheels and gyro
    double right_minus_left = 0;           ///< m, by the calibration scaled to the nominal B
    double distance = 0;                   ///< m, (|left| + |right|)/2
    bool both_sides_read = false;          ///< in this step
    double yaw_rate = 0;                   ///< rad/s
  };

  MotionDifference() = default;
  explicit MotionDifference(const SlipParams& params) noexcept : params_(params) {}

  void restart() noexcept;  ///< without any point
  /// A slide ended: the past is laid on a straight line of E of that slope, m/s, odom axes, and on a constant W.
  void restart_on_line(const Planar& slope) noexcept;
  /// The robot was at rest until a moment ago. `velocity` m/s, odom axes: what the accelerometer has integrated since.
  void restart_at_rest(double yaw, const Vector3& up, const Planar& velocity) noexcept;
  /// The pose was set: the path until now is not to be corrected any more.
  void begin_path() noexcept { path_begin_ = time(); }
  double path_begin() const noexcept { return path_begin_; }  ///< s
  /// s: τ. During a slide it must not change: the slide keeps differences.
  void set_clock_offset(double offset) noexcept { clock_offset_ = offset; }

  /// True: a point was added.
  bool step(const Sample& sample) noexcept;

  double time() const noexcept { return now_.inertial.time; }  ///< s, of the last step
  bool empty() const noexcept { return count_ == 0; }
  /// The newest point that is known; there must be one.
  Point last() const noexcept { return difference(record(last_index())); }
  Point before(double time) const noexcept;  ///< the newest point that is not later, else the oldest

 private:
  static constexpr std::size_t kPoints = 64;

  /// Both motions until `inertial.time`.
  struct Record {
    InertialMotion inertial;
    Planar wheel_path{};          ///< m, odom axes
    double right_minus_left = 0;  ///< m
    double distance = 0;          ///< m
  };

  Planar lever(double yaw, const Vector3& up) const noexcept;
  bool waits() const noexcept { return clock_offset_ < 0; }  ///< for the IMU
  const Record& record(std::size_t i) const noexcept { return records_[i % kPoints]; }
  std::size_t oldest() const noexcept { return count_ > kPoints ? count_ - kPoints : 0; }
  std::size_t last_index() const noexcept { return index_before(waits() ? time() + clock_offset_ : time()); }
  std::size_t index_before(double time) const noexcept;  ///< of the newest record that is not later, else the oldest
  InertialMotion inertial_at(double time) const noexcept;
  Point difference(const Record& record) const noexcept;

  SlipParams params_;
  std::array<Record, kPoints> records_{};  ///< ring, at least Tuning::kPointInterval apart
  std::size_t count_ = 0;
  Record now_;
  double clock_offset_ = 0;
  double path_begin_ = 0;
};

}  // namespace robot_control
