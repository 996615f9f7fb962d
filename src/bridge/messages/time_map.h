#pragma once
/// Sample stamps → ROS time, never backwards.
///
/// Wall clock: stamps are CLOCK_MONOTONIC, behind it by what a simulated plant let slip or was held; ROS time is the
/// time of day:   ros = stamp + offset,   offset → (time of day − monotonic) as measured + slipped + held.
/// An offset that grew is adopted at once; one that shrank (the system's clock was set back) is approached by at
/// most half of the stamps' progress, so that ROS time slows down but never turns back.
/// Lockstep: the stamps are the time, and the driver publishes them on /clock.

#include <cstdint>

#include "parameters/parameters.h"
#include "signals/sensor_frame.h"

namespace ros {
class Time;
}

namespace robot_control {

class TimeMap {
 public:
  explicit TimeMap(ClockMode clock) noexcept : clock_(clock) {}

  /// Before each use: `stamp_ns` of the newest frame, `offset_ns` measured now.
  void update(std::int64_t stamp_ns, std::int64_t offset_ns) noexcept;

  /// Measures the offset itself; `sensors` is the newest frame of the driver.
  void follow(const SensorFrame& sensors);

  std::int64_t ros_ns(std::int64_t stamp_ns) const noexcept;
  ros::Time at(std::int64_t stamp_ns) const;

 private:
  ClockMode clock_;
  bool first_ = true;
  std::int64_t stamp_ns_ = 0;
  std::int64_t offset_ns_ = 0;
};

}  // namespace robot_control
