#pragma once
/// Corrupts the output frames of a node for the injected faults kGarbage and kWrong (signals/injected_fault.h).
///
///              kGarbage                                          kWrong
///   state      every number of pose, twist and bias              the motion mirrored: x, y, speeds, with their sign
///   command    every number of every joint, and its mode         every effort, speed and angle with the other sign
///   permit     an action, a state and causes at random           drives where it should brake, brakes where it
///                                                                should drive
///
/// A garbage number is uniform within ±kGarbage, one in eight NaN, one in eight infinite. What is wrong is finite and
/// plausible, and its flags say that all is well. Heads are the caller's.

#include "faults/faulty_output.h"
#include "signals/command_frame.h"
#include "signals/permit.h"
#include "signals/state_frame.h"

namespace robot_control {

inline constexpr double kGarbage = 1000;

void distort(FaultKind kind, StateFrame& state, FaultRandom& random) noexcept;
void distort(FaultKind kind, CommandFrame& command, FaultRandom& random) noexcept;
void distort(FaultKind kind, Permit& permit, FaultRandom& random) noexcept;

}  // namespace robot_control
