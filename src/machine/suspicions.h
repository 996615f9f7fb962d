#pragma once
/// Notes properties that a machine hardly has as suspicious:
///
///   lengths   a shape larger than kMaxPart: probably millimetres
///   masses    more than a block of steel with the size of the box about all shapes: probably grams
///   base      less than kMinBaseShare of the mass is in the root and the parts fixed to it: a missing <inertial>
///   held      the effort limit of a held joint is below the weight that the joint bears at rest

#include <string>

#include "machine/machine_model.h"

namespace robot_control {

inline constexpr double kMaxPart = 20;         ///< m
inline constexpr double kSteelDensity = 7850;  ///< kg/m³
inline constexpr double kMinBaseShare = 0.15;

/// Adds the notes to a machine with bodies.
void note_suspicious_bodies(MachineModel& machine);

/// Returns all suspicious notes in one sentence, for an error that they may explain; empty: none.
std::string suspicions_of(const MachineModel& robot);

}  // namespace robot_control
