#pragma once
/// One turn of a laser, as in sensor_msgs/LaserScan, without ROS.

#include <cstddef>
#include <limits>
#include <vector>

namespace robot_control::navigation {

struct Scan {
  double angle_min = 0, angle_increment = 0;  ///< rad; a negative increment is that of a laser on its head
  double range_min = 0, range_max = 0;        ///< m
  std::vector<float> ranges;                  ///< m; neither `hit` nor `nothing`: not measured
  double angle_max = std::numeric_limits<double>::quiet_NaN();  ///< rad, of the last ray as stated; NaN: not stated

  /// Returns whether the range is that of an echo.
  bool hit(float range) const noexcept { return range >= range_min && range > 0 && range < range_max; }

  /// Returns whether there is no echo up to range_max, which some drivers report instead of +∞.
  bool nothing(float range) const noexcept { return range >= range_max; }

  double angle(std::size_t ray) const noexcept { return angle_min + static_cast<double>(ray) * angle_increment; }
};

}  // namespace robot_control::navigation
