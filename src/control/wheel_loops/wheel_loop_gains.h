#pragma once
/// The gains of a wheel loop: the user's, or derived from the robot and the rate where the user left them out.
///
///   model_inertia = 2·max(J, d/(2π·bandwidth))           J: of the lifted wheel, rotor included (wheel_loop.h)
///   kp = min(0.4·J/dt, 31 s⁻¹·J_straight)                J_straight: what it sees driving straight (feed_forward.h)
///   ki = min(10 s⁻¹·kp, kp²/(3·J_straight))
///   kd = 0
///   bandwidth = min(20 Hz, rate/25)                      of the tracking loop
///
/// d N·m·s/rad, the joint's damping. Where d/J is faster than the tracking loop, a torque τ that the plan did not ask
/// for turns the wheel by τ/d and no more; told τ/J, the loop would see speeds that are not there: 10³ rad/s for a
/// wheel of 3.4e-5 kg·m² in a joint of 0.2 N·m·s/rad that crept at 1 rad/s between two brakes.
///
/// 0.4·J/dt: kp·dt/model_inertia = 0.2, a fifth of what the loop's delay allows whatever the wheel drives. 31 s⁻¹: the
/// pace kp/J of the loaded wheel; a faster one would tear at the encoder's counts and gain nothing, for the plan comes
/// by feed-forward. ki: 0.1 s, and not faster than a third of that pace, which keeps the damping √(3)/2 or more.
/// rate/25: 2π·bandwidth·dt ≤ 0.25; quicker, the tracking loop's own lag eats the margin at 100 … 400 Hz.
///
/// In units of J_straight and dt only J/J_straight and the rate are left. With these the spectral radius is below 1
/// for 100 … 2000 Hz, J/J_straight of 0.01 … 1 and every inertia between J and 10·J_straight, and all gains may be
/// multiplied by 4, with d/J of 0 … 10⁴ 1/s by 3 (tests/control/wheel_loop_gains_test.cpp). 12 kg, 1 kHz: 2 N·m·s/rad
/// and 20 N·m/rad; 333 Hz: 0.67 and 2.3; 100 Hz: 0.2 and 0.2.
///
/// They bear two cycles of delay beyond the bus' one. From three on, at 1 kHz, the tyres of most robots slip in a limit
/// cycle at full torque; with half of kp and a quarter of ki, from ten on (tests/loop/test_closed_loop.py).

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
