#pragma once
/// A UnitreeLeggedFront is a simulated Go1.

#include "drivers/unitree/unitree_front.h"
#include "drivers/unitree_legged/go1.h"

namespace robot_control {

using UnitreeLeggedFront = UnitreeFront<Go1>;

}  // namespace robot_control
