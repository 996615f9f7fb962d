#pragma once
/// The gains of a wheel loop: the user's, or derived from the robot and the rate if the user left them out.
///
///   model_inertia = 2·max(J, d/(2π·bandwidth))           J: of the lifted wheel, rotor included (wheel_loop.h)
///   kp = min(0.4·J/dt, 31 s⁻¹·J_straight)                J_straight: when driving straight (feed_forward.h)
///   ki = min(10 s⁻¹·kp, kp²/(3·J_straight))
///   kd = 0
///   bandwidth = min(20 Hz, rate/25)                      of the tracking loop
///
/// d N·m·s/rad, the joint's damping. If d/J is faster than the tracking loop, a torque τ that was not planned turns the
/// wheel at τ/d, and no faster. With the inertia J the tracking loop would assume τ/J and predict speeds that do not
/// exist.
///
/// 0.4·J/dt: kp·dt/model_inertia = 0.2, a fifth of what the loop's delay allows for any load. 31 s⁻¹: the pace kp/J of
/// the loaded wheel; a faster one amplifies encoder quantisation without benefit, because the plan is driven by
/// feed-forward. ki: 0.1 s, and not faster than a third of that pace, which keeps the damping ratio of kp
/// and ki with the inertia alone at √(3)/2 or more; with tracking loop and delay it is 0.5 … 0.6.
/// rate/25: 2π·bandwidth·dt ≤ 0.25; with a faster tracking loop its own lag removes the margin at 100 … 400 Hz.
///
/// In units of J_straight and dt only J/J_straight and the rate remain. With these gains the spectral radius is below 1
/// for 100 … 2000 Hz, J/J_straight of 0.01 … 1 and every inertia between J and 10·J_straight. Margins, tolerated delays
/// and examples: docs/evidence/derivations.md.

#include "control/drive_controller_parameters.h"
#include "control/wheel_loops/wheel_loop.h"
#include "robot/robot_model.h"

namespace robot_control {

/// `wheel` is one of the robot's; `period` > 0, s.
WheelLoopGains wheel_loop_gains(const DriveControllerParameters& parameters, const RobotModel& robot,
                                const WheelModel& wheel, double period) noexcept;

/// Hz, of the tracking loops.
double tracking_bandwidth(const DriveControllerParameters& parameters, double period) noexcept;

}  // namespace robot_control
