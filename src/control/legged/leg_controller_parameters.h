#pragma once
/// These are the user's parameters of the leg controller.

#include "control/legged/walk/own_gaits.h"
#include "parameters/block.h"

namespace robot_control {

struct LegControllerParameters {
  double request_timeout = 1.25;          ///< s, of cmd_vel, body_pose and foot_target; 0 = never
  bool one_sender = false;                ///< No request is accepted while several nodes send, and one requests motion.
  double max_linear_speed = 1.5;          ///< m/s, to the front and back
  double max_lateral_speed = 0.5;         ///< m/s
  double max_angular_speed = 2;           ///< rad/s
  double max_linear_acceleration = 2;     ///< m/s²
  double max_lateral_acceleration = 1.5;  ///< m/s²
  double max_angular_acceleration = 4;    ///< rad/s²
  double friction = 0.4;                  ///< of the ground, up to which the feet push sideways
  double lie_down_after = 0;              ///< s without a request of motion; 0 = never
  OwnGaits gaits{};
};

inline Keys keys(LegControllerParameters& legs) {
  Keys all{
      {"request_timeout", &legs.request_timeout, "s", 0, 60, kLoopTimeout | kZeroIsOff},
      {"one_sender", &legs.one_sender},
      {"max_linear_speed", &legs.max_linear_speed, "m/s", 0.001, 50},
      {"max_lateral_speed", &legs.max_lateral_speed, "m/s", 0.001, 50},
      {"max_angular_speed", &legs.max_angular_speed, "rad/s", 0.001, 50},
      {"max_linear_acceleration", &legs.max_linear_acceleration, "m/s²", 0.001, 100},
      {"max_lateral_acceleration", &legs.max_lateral_acceleration, "m/s²", 0.001, 100},
      {"max_angular_acceleration", &legs.max_angular_acceleration, "rad/s²", 0.001, 1000},
      {"friction", &legs.friction, {}, 0.05, 2},
      {"lie_down_after", &legs.lie_down_after, "s", 0, 1.0e6, kZeroIsOff},
  };
  return joined({all, keys(legs.gaits)});
}

}  // namespace robot_control
