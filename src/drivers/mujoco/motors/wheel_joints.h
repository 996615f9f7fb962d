#pragma once
/// wheel_joints returns the wheels of one side as indices into the frames' joint arrays.

#include <cstddef>
#include <vector>

#include "machine/wheeled/drive_train.h"

namespace robot_control {

inline std::vector<std::size_t> wheel_joints(const DriveTrain& robot, Side side) {
  std::vector<std::size_t> joints;
  for (const WheelModel& wheel : robot.wheels) {
    if (wheel.side == side) joints.push_back(wheel.joint);
  }
  return joints;
}

}  // namespace robot_control
