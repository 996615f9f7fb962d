#pragma once
/// The straight line that E (motion_difference.h) follows without slip, carried on through a slide, and its error.
///
///   speed error²(t) = σ² + (slow t)² + white² t
///
/// t: time since which it is carried on by the accelerometer alone; σ: standard deviation of its slope at that time.

#include "estimation/slip/motion_difference.h"
#include "estimation/slip/residual_levels.h"

namespace robot_control {

class SlideLine {
 public:
  /// Through two points before the slide. `slope_deviation` m/s: of one residual.
  void begin(const MotionDifference::Point& older, const MotionDifference::Point& onset, const AccelerationNoise& noise,
             double slope_deviation) noexcept;
  /// Other information on the slope: `change` m/s, odom axes; `deviation` m/s.
  void renew(const Planar& change, double deviation) noexcept;
  void set_slope(const Planar& slope) noexcept { slope_ = slope; }
  /// It is known at that time, s, and carried on from there.
  void begin_at(double time) noexcept { begin_ = time; }

  const Planar& slope() const noexcept { return slope_; }                              ///< m/s, odom axes
  double begin_time() const noexcept { return begin_; }                                ///< s
  double speed_deviation(double time, const AccelerationNoise& noise) const noexcept;  ///< m/s

 private:
  Planar slope_;
  double begin_ = 0;
  double deviation_ = 0;  ///< m/s: σ
};

}  // namespace robot_control
