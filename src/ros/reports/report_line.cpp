#include "ros/reports/report_line.h"

#include <ros/console.h>

namespace robot_control {

void write_log(const std::vector<ReportLine>& lines) {
  for (const ReportLine& line : lines) {
    if (line.warning) {
      ROS_WARN("%s", line.text.c_str());
    } else {
      ROS_INFO("%s", line.text.c_str());
    }
  }
}

}  // namespace robot_control
