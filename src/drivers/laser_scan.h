#pragma once
/// A LaserScan is one turn of a simulated laser scanner in the axes of its link. Ray i points along
/// angle_min + i · angle_increment about z, counted from x towards y.

#include <string>
#include <vector>

#include "signals/frame_head.h"

namespace robot_control {

struct LaserScan {
  FrameHead head;                             ///< of the true state that was scanned; all rays are of this time
  std::string link;                           ///< its frame
  double angle_min = 0, angle_increment = 0;  ///< rad
  double range_min = 0, range_max = 0;        ///< m
  std::vector<float> ranges;                  ///< m; +∞: nothing came back, −∞: nearer than range_min (REP 117)
};

}  // namespace robot_control
