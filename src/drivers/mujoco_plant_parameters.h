#pragma once
/// What a user sets of the simulated machine.

#include <cstdint>
#include <string>

namespace robot_control {

struct MujocoPlantParameters {
  std::string scene;              ///< MJCF path: the world around the robot
  std::uint64_t seed = 0;         ///< of every random number in the plant; it draws none yet, its sensors are exact
  std::uint64_t cycles = 0;       ///< the node ends by itself after so many cycles; 0 = never
  double brake_effort = 3.0;      ///< N·m, the brake's bound per joint
  double brake_damping = 2.0;     ///< N·m·s/rad
  double brake_stiffness = 300;   ///< N·m/rad, position hold below `brake_hold_speed`
  double brake_hold_speed = 0.3;  ///< rad/s
};

}  // namespace robot_control
