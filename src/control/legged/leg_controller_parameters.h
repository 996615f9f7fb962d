#pragma once
/// These are the user's parameters of the leg controller.

#include "parameters/block.h"

namespace robot_control {

struct LegControllerParameters {
  double request_timeout = 1.25;  ///< s, of body_pose and foot_target; 0 = never
  bool one_sender = false;        ///< No request is accepted while more than one node sends.
};

inline Keys keys(LegControllerParameters& legs) {
  return {
      {"request_timeout", &legs.request_timeout, "s", 0, 60, kLoopTimeout | kZeroIsOff},
      {"one_sender", &legs.one_sender},
  };
}

}  // namespace robot_control
