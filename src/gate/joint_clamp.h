#pragma once
/// Clamps one joint's command to the limits of that joint. A value within its limit passes bit for bit. Each function
/// returns GateReason bits, 0 where nothing was clamped.
///
/// q: position, v: speed, e: effort, all of the joint; its torque is that of JointMode.

#include <cstdint>

#include "gate/gate_parameters.h"
#include "signals/joint.h"

namespace robot_control {

/// The effort that may be pushed towards more speed tapers to nothing from this part of the speed limit on.
inline constexpr double kTaperStart = 0.9;

/// Gains below zero, which would accelerate every motion, are 0.
std::uint64_t clamp_gains(JointCommand& command) noexcept;

/// |e| ≤ limits.effort. The driver clamps the total torque of its law.
std::uint64_t clamp_effort(const JointLimits& limits, JointCommand& command) noexcept;

/// low ≤ e ≤ high.
std::uint64_t clamp_rate(double low, double high, JointCommand& command) noexcept;

/// kDriveVelocity: low ≤ velocity ≤ high.
std::uint64_t clamp_acceleration(double low, double high, JointCommand& command) noexcept;

/// Towards more speed, with x = |v|/limits.velocity and taper = (1 − x)/(1 − kTaperStart) within 0 … 1:
///   e ≤ taper·limits.effort        kImpedance: stiffness · taper while its spring pulls that way
///   kVelocity, kImpedance, kDriveVelocity: |velocity| ≤ limits.velocity
/// Against the motion everything is free.
std::uint64_t clamp_speed(const JointLimits& limits, double position, double speed, JointCommand& command) noexcept;

/// Towards an end stop, with d the way left to it and taper = d/soft_zone within 0 … 1:
///   e ≤ taper·limits.effort        with a velocity: velocity ≤ taper·limits.velocity (unknown: of itself)
///   kImpedance: lower ≤ position ≤ upper
///   d ≤ 0: effort or velocity towards it becomes the brake of this joint
/// Away from it everything is free.
std::uint64_t clamp_position(const JointLimits& limits, double position, JointCommand& command) noexcept;

}  // namespace robot_control
