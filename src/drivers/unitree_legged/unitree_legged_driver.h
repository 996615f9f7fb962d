#pragma once
/// A Unitree Go1 at its low level as a Driver.
///
/// Check sums that were never right are those of a firmware that encrypts them, which is not supported. States of
/// another length are those of an A1 or Aliengo.

#include "drivers/unitree/unitree_driver.h"
#include "drivers/unitree_legged/go1.h"

namespace robot_control {

using UnitreeLeggedDriver = UnitreeDriver<Go1>;

}  // namespace robot_control
