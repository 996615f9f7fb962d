#pragma once
/// Corrupts the output frames of a node for the injected faults kGarbage and kWrong (signals/injected_fault.h).
///
///              kGarbage                                          kWrong
///   state      every number of pose, twist and bias              x, y and speeds with the opposite sign
///   command    every number and the mode of every joint          every effort, speed and angle with the opposite sign
///   permit     a random action, state and causes                 drives instead of braking, brakes instead of driving
///
/// A garbage number is uniform within ±kGarbage; one in eight is NaN, one in eight infinite. A wrong frame is finite
/// and plausible, and its flags are those of a healthy one. The caller fills in the heads.

#include "signals/command_frame.h"
#include "signals/permit.h"
#include "signals/state_frame.h"
#include "simulation/faults/faulty_output.h"

namespace robot_control {

inline constexpr double kGarbage = 1000;

void distort(FaultKind kind, StateFrame& state, FaultRandom& random) noexcept;
void distort(FaultKind kind, CommandFrame& command, FaultRandom& random) noexcept;
void distort(FaultKind kind, Permit& permit, FaultRandom& random) noexcept;

}  // namespace robot_control
