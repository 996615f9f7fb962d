#pragma once
/// The motion by wheels and gyro minus the motion by the accelerometer, without the state of a filter.
///
///   E = path by wheels and gyro + lever of the IMU − ∬ acceleration dt²        path_difference: m, odom axes
///   W = right − left − B ψ                                                     turn_difference: m
///
/// The path is that of the middle of the wheels; the acceleration is the IMU's, gravity removed; the lever leads from
/// the middle of the wheels to the IMU and turns with the yaw ψ, which is the gyro's; B is the wheel base. While no
/// wheel slips E is a straight line, whose slope is the speed at the beginning, which the integral does not contain,
/// and W is a constant. Time begins at 0 with every restart.

#include <array>
#include <cstddef>

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
    double time = 0;             ///< s
    Planar path_difference{};    ///< m, odom axes: E
    double turn_difference = 0;  ///< m: W
    double distance = 0;         ///< m, always growing
    double yaw = 0;              ///< rad
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
  /// With points in the past on a straight line of E of that slope, m/s, odom axes: slip is noticed at once.
  void restart_on_line(const Planar& slope) noexcept;
  /// The robot was at rest until now.
  void restart_at_rest(double yaw, const Vector3& up) noexcept;
  /// The pose was set: the path until now is not to be corrected any more.
  void begin_path() noexcept { path_begin_ = now_.time; }
  double path_begin() const noexcept { return path_begin_; }  ///< s

  /// True: a point was added.
  bool step(const Sample& sample) noexcept;

  const Point& now() const noexcept { return now_; }
  bool empty() const noexcept { return count_ == 0; }
  const Point& last() const noexcept { return points_[(count_ - 1) % kPoints]; }
  const Point& before(double time) const noexcept;  ///< the newest point that is not later, else the oldest

 private:
  static constexpr std::size_t kPoints = 64;

  Planar lever(double yaw, const Vector3& up) const noexcept;

  SlipParams params_;
  std::array<Point, kPoints> points_{};  ///< ring, at least Tuning::kPointInterval apart
  std::size_t count_ = 0;
  Point now_;
  Planar inertial_path_;  ///< m, odom axes
  Planar wheel_path_;     ///< m, odom axes
  Planar lever_;          ///< m, odom axes
  double path_begin_ = 0;
};

}  // namespace robot_control
