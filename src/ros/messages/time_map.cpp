#include "ros/messages/time_map.h"

#include <ros/time.h>

#include <algorithm>

#include "rt/clock.h"
#include "signals/trace.h"

namespace robot_control {

void TimeMap::update(std::int64_t stamp_ns, std::int64_t offset_ns) noexcept {
  const std::int64_t progress = std::max<std::int64_t>(0, stamp_ns - stamp_ns_);
  const std::int64_t lowest = offset_ns_ - progress / 2;
  offset_ns_ = first_ ? offset_ns : std::max(offset_ns, lowest);
  stamp_ns_ = first_ ? stamp_ns : std::max(stamp_ns, stamp_ns_);
  first_ = false;
}

void TimeMap::follow(const SensorFrame& sensors) {
  if (clock_ == ClockMode::kLockstep) return;
  constexpr std::int64_t kPreempted = 50'000;  // ns; a longer gap between the readings would distort the offset
  const std::int64_t before = monotonic_ns();
  const auto day = static_cast<std::int64_t>(ros::WallTime::now().toNSec());
  const std::int64_t gap = monotonic_ns() - before;
  if (gap >= kPreempted && !first_) return;
  update(sensors.head.stamp_ns, day - before - gap / 2 + due_ns(sensors) - sensors.head.stamp_ns);
}

std::int64_t TimeMap::ros_ns(std::int64_t stamp_ns) const noexcept {
  return clock_ == ClockMode::kLockstep ? stamp_ns : stamp_ns + offset_ns_;
}

ros::Time TimeMap::at(std::int64_t stamp_ns) const {
  ros::Time time;
  return time.fromNSec(static_cast<std::uint64_t>(std::max<std::int64_t>(0, ros_ns(stamp_ns))));
}

}  // namespace robot_control
