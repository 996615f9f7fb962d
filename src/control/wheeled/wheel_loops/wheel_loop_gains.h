#pragma once
/// The gains of a wheel loop are set by the user or derived from the robot and the rate.
///
///   model_inertia = 2·max(J, d/(2π·bandwidth))           J: of the lifted wheel, rotor included (wheel_loop.h)
///   kp = min(0.4·J/dt, 31 s⁻¹·J_straight)                J_straight: when driving straight (feed_forward.h)
///   ki = min(10 s⁻¹·kp, kp²/(3·J_straight))
///   kd = 0
///   bandwidth = min(20 Hz, rate/25)                      of the tracking loop
///
/// d (N·m·s/rad) is the joint's damping. If d/J is faster than the tracking loop, an unplanned torque τ turns the wheel
/// at τ/d, and no faster. With the inertia J the tracking loop would assume τ/J and predict speeds that do not exist.
///
///   0.4·J/dt   kp·dt/model_inertia = 0.2, a fifth of what the loop's delay allows for any load
///   31 s⁻¹     pace kp/J of the loaded wheel; a faster one amplifies encoder quantisation without benefit
///   ki         0.1 s, and not faster than a third of that pace: the damping ratio is √(3)/2 or more with the inertia
///              alone, and 0.5 … 0.6 with tracking loop and delay
///   rate/25    2π·bandwidth·dt ≤ 0.25; the lag of a faster tracking loop removes the margin at 100 … 400 Hz
///
/// In units of J_straight and dt only J/J_straight and the rate remain. The spectral radius is below 1 for 100 … 2000
/// Hz, J/J_straight of 0.01 … 1 and every inertia between J and 10·J_straight. Margins, tolerated delays and examples
/// are in docs/evidence/derivations.md.

#include "control/wheeled/drive_controller_parameters.h"
#include "control/wheeled/wheel_loops/wheel_loop.h"
#include "machine/wheeled/drive_train.h"

namespace robot_control {

/// `wheel` is one of the robot's wheels; `period` is in s, > 0.
WheelLoopGains wheel_loop_gains(const DriveControllerParameters& parameters, const DriveTrain& robot,
                                const WheelModel& wheel, double period) noexcept;

/// Returns the bandwidth of the tracking loops in Hz.
double tracking_bandwidth(const DriveControllerParameters& parameters, double period) noexcept;

}  // namespace robot_control
