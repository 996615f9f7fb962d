#pragma once

#include <optional>
#include <vector>

#include "parameters/block.h"

namespace robot_control {

/// The side to which the knees of a standing robot point.
enum class KneeBend {
  kDerived,   ///< the side that the ranges leave; where they leave both, towards the middle of the robot
  kMiddle,    ///< front knees backward, rear knees forward
  kOutwards,  ///< front knees forward, rear knees backward
  kForward,
  kBackward,
};

inline std::vector<Word> words_of(KneeBend) {
  return {{"derived", KneeBend::kDerived},
          {"middle", KneeBend::kMiddle},
          {"outwards", KneeBend::kOutwards},
          {"forward", KneeBend::kForward},
          {"backward", KneeBend::kBackward}};
}

/// The user's values for a robot with legs, in the block `robot:`. They have no effect on a robot with wheels.
struct LegParameters {
  KneeBend knee_bend = KneeBend::kDerived;
  /// kg·m², of each leg joint's rotor times its gear ratio squared; none: of the robot's size (leg_model.h)
  std::optional<double> leg_rotor_inertia = std::nullopt;
};

inline Keys keys(LegParameters& legs) {
  return {
      {"knee_bend", &legs.knee_bend, {}, 0, 0, kOptional},
      {"leg_rotor_inertia", &legs.leg_rotor_inertia, "kg·m²", 0, 10, kOptional},
  };
}

}  // namespace robot_control
