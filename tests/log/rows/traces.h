#pragma once
/// Rows in the form of four healthy nodes.

#include <string>
#include <vector>

#include "signals/trace.h"

namespace robot_control {

inline const std::vector<std::string> kJoints{"left_wheel_joint", "right_wheel_joint"};
inline const std::vector<std::string> kContactLinks{"left_wheel_link", "right_wheel_link"};

/// Run starts lie far apart, so that stamps order runs as a driver's do.
inline FrameHead head_at(std::uint64_t run, std::uint64_t cycle) {
  FrameHead head;
  head.run = run;
  head.cycle = cycle;
  head.stamp_ns = static_cast<std::int64_t>(run * 1'000'000'000'000 + cycle * 1'000'000);
  return head;
}

inline DriverTrace driver_row(std::uint64_t run, std::uint64_t cycle) {
  DriverTrace row;
  row.sensors.head = row.truth.head = head_at(run, cycle);
  row.truth.contact_count = kContactLinks.size();
  return row;
}

inline EstimatorTrace estimator_row(std::uint64_t run, std::uint64_t cycle) {
  EstimatorTrace row;
  row.state.head = head_at(run, cycle);
  return row;
}

inline ControllerTrace controller_row(std::uint64_t run, std::uint64_t cycle) {
  ControllerTrace row;
  row.command.head = head_at(run, cycle);
  return row;
}

inline MonitorTrace monitor_row(std::uint64_t run, std::uint64_t cycle) {
  MonitorTrace row;
  row.permit.head = head_at(run, cycle);
  return row;
}

}  // namespace robot_control
