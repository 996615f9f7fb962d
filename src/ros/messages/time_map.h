#pragma once
/// A TimeMap converts stamps of samples to ROS time, which never goes backwards.
///
/// Wall clock: stamps are CLOCK_MONOTONIC, less the delays of a simulated plant (`slipped`) and its pauses (`held`).
/// ROS time is the time of day:
///   ros = stamp + offset,   offset → (time of day − monotonic) as measured + slipped + held.
/// A larger offset is adopted at once. A smaller one (the system's clock was set back) is approached by at most half of
/// the stamps' progress: ROS time slows down, but never goes backwards. Lockstep: the stamps are ROS time, and the
/// driver publishes them on /clock.

#include <cstdint>

#include "configuration/loop_parameters.h"
#include "signals/sensor_frame.h"

namespace ros {
class Time;
}

namespace robot_control {

class TimeMap {
 public:
  explicit TimeMap(ClockMode clock) noexcept : clock_(clock) {}

  /// Adopts the measured offset `offset_ns`; `stamp_ns` is that of the newest frame. It is called before each use.
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
