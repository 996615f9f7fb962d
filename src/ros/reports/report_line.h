#pragma once
/// One line of a node's log.

#include <string>
#include <vector>

namespace robot_control {

struct ReportLine {
  bool warning = false;
  std::string text;
};

/// Writes the lines to the log of ROS at level WARN or INFO.
void write_log(const std::vector<ReportLine>& lines);

}  // namespace robot_control
