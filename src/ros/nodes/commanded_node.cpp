#include "ros/nodes/commanded_node.h"

#include <ros/ros.h>

#include "ros/network/graph.h"
#include "ros/reports/report_line.h"

namespace robot_control {

EarlierController CommandedNode::earlier_controller(ros::NodeHandle& handle, const std::vector<std::string>& topics) {
  std::vector<std::string> resolved;
  for (const std::string& topic : topics) resolved.push_back(handle.resolveName(topic));
  EarlierController earlier;
  earlier.period_ns = parameters().loop.period_ns();
  const Lookup found = process().output().last_whole(command_);
  if (found == Lookup::kFrame) earlier.run = command_.head.run;
  earlier.requested = found == Lookup::kFrame ? requests_motion(command_) : found == Lookup::kCorrupt;
  for (const std::string& node : publishers_of(resolved, Unanswered::kRepeat))
    earlier.present.push_back({node, nullptr, uri_of(node)});
  return earlier;
}

ArrivalTime CommandedNode::arrival_of(const std::string& sender) {
  log_dropped(sender);
  follow_permission();
  const bool lockstep = parameters().loop.clock == ClockMode::kLockstep;
  ArrivalTime time{.ros_ns = 0, .loop_ns = loop_ns()};
  time.ros_ns = lockstep ? time.loop_ns : static_cast<std::int64_t>(ros::WallTime::now().toNSec());
  return time;
}

/// Returns true if the command in force ended. The caller holds input_mutex_.
bool CommandedNode::follow_permission() {
  Permit permit;
  if (process().permits().newest(permit) != Lookup::kFrame || !process().is_current(permit.head)) return false;
  return intake_->follow(motion_permission(permit), loop_ns());
}

/// A command that arrives before the loop runs has no effect later. This is reported once until the loop has run.
void CommandedNode::log_dropped(const std::string& sender) {
  SensorFrame sensors;
  CommandFrame command;
  const bool runs = process().sensors().newest(sensors) == Lookup::kFrame && process().is_current(sensors.head) &&
                    process().output().newest(command) == Lookup::kFrame && command.head.run == sensors.head.run;
  if (!runs && !dropped_reported_) {
    ROS_WARN("a command of %s arrived before the loop runs and is ignored; send it again when safety_status is READY",
             sender.c_str());
  }
  dropped_reported_ = !runs;
}

std::int64_t CommandedNode::loop_ns() {
  SensorFrame sensors;
  const bool found = process().sensors().newest(sensors) == Lookup::kFrame && process().is_current(sensors.head);
  if (found) loop_ns_ = sensors.head.stamp_ns;
  return loop_ns_;
}

void CommandedNode::look_at_senders() {
  std::vector<ReportLine> lines;
  {
    const std::lock_guard lock(input_mutex_);
    const bool ended = follow_permission();
    if (intake_->update(loop_ns()) || ended) store();
    lines = intake_->lines();
  }
  write_log(lines);
}

bool CommandedNode::follow_command() {
  SensorFrame sensors;
  if (process().sensors().newest(sensors) != Lookup::kFrame || !process().is_current(sensors.head)) return false;
  look_at_senders();
  if (process().output().newest(command_) != Lookup::kFrame || command_.head.run != sensors.head.run) return false;
  reports_ = history_.collect(process().output(), command_);
  since_message_ |= reports_.reasons;
  since_report_ |= reports_.reasons;
  time().follow(sensors);
  return true;
}

}  // namespace robot_control
