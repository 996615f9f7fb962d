#pragma once
/// The driver publishes imu/data_raw, ground_truth/odom and, in lockstep, /clock, and sets robot_description. It has
/// the services ~set_pause, ~step, ~reset and ~inject_fault. With `robot.imu: topic` it takes the IMU from imu/input.

#include <memory>

#include "drivers/driver.h"
#include "robots/robot.h"
#include "ros/nodes/node.h"

namespace robot_control {

/// Makes a driver, which the node starts. Throws DriverError.
using MakeDriver = std::unique_ptr<Driver> (*)(const Parameters&, const Robot&);

/// The node publishes robot_description after it has taken the locks and before its first frame.
std::unique_ptr<Node> make_driver_node(const Setup& setup, MakeDriver make);

}  // namespace robot_control
