#pragma once
/// Stop causes in words: the condition, its remedy, and the person who can apply it. What latched needs e_stop_reset
/// after its remedy; an empty remedy: nothing else.
///
///   operator     drives the robot
///   integrator   sets the robot up: nodes, parameters, URDF, network
///   technician   repairs the machine: sensors, motors, cables, battery

#include <array>

#include "signals/bit_name.h"
#include "signals/permit.h"

namespace robot_control {

// clang-format off
inline constexpr auto kStopCauseNames = std::to_array<BitName>({
    {kCauseEmergencyStopTopic, "e_stop_topic", "the topic e_stop said true",
     "publish false on e_stop", "operator"},
    {kCauseEmergencyStopService, "e_stop_service", "e_stop_trigger was called", "", "operator"},
    {kCauseEmergencyStopInput, "e_stop_input", "the emergency stop button is pressed",
     "release the button; where it is, look at its cable", "operator"},
    {kCauseDriverLost, "driver_lost", "no current sensor frame came for loss_cycles periods, or the driver was restarted",
     "look whether the driver node runs and gets its core", "integrator"},
    {kCauseDriverFault, "driver_fault", "the driver reports a fault",
     "read the driver's fault, repair it, restart or reset the driver", "technician"},
    {kCauseControllerLost, "controller_lost", "the controller published no command for loss_cycles cycles",
     "look whether diff_drive_controller runs", "integrator", "cycles"},
    {kCauseEstimatorLost, "estimator_lost", "the estimator published no state for loss_cycles cycles",
     "look whether state_estimator runs", "integrator", "cycles"},
    {kCauseHeartbeatLost, "heartbeat_lost", "the operator's heartbeat stopped",
     "publish heartbeat again", "operator", "s"},
    {kCauseMonitorRestarted, "monitor_restarted", "the safety monitor was restarted while the driver ran on",
     "", "operator"},
    {kCauseCorruptFrame, "corrupt_frame", "frames with a wrong checksum were read",
     "look for two builds on one bus or failing memory", "integrator", "cycles"},
    {kCauseNotFinite, "not_finite", "sensors or command held NaN or infinity",
     "look at the sensors and at the controller's log", "technician", "cycles"},
    {kCauseMonitorLate, "monitor_late", "the safety monitor missed more than loss_cycles cycles",
     "look what keeps safety_monitor from its core", "integrator", "cycles"},
    {kCauseEncodersLost, "encoders_lost", "the wheel encoders report nothing",
     "look at the encoders' cables and power", "technician", "s"},
    {kCauseImuLost, "imu_lost", "gyro or accelerometer report nothing any more",
     "look at the IMU's cable and power", "technician", "s"},
    {kCauseImuStuck, "imu_stuck", "gyro or accelerometer repeat one sample while the wheels turn",
     "restart the IMU or its driver", "technician", "s"},
    {kCauseCommandStale, "command_stale", "the controller's commands descend from an old state",
     "look what keeps diff_drive_controller and state_estimator from their core",
     "integrator", "cycles"},
    {kCauseWheelSpeed, "wheel_speed", "a wheel is faster than allowed",
     "look at load, slope, encoder and motor of that wheel", "technician", "rad/s"},
    {kCauseWheelAcceleration, "wheel_acceleration", "a wheel's speed changes faster than its motor can make it",
     "look at the encoder of that wheel", "technician", "rad/s²"},
    {kCauseWheelEffort, "wheel_effort", "a motor gives more torque than it may",
     "look at the drive of that wheel", "technician", "of its limit"},
    {kCausePower, "power", "the motors draw more mechanical power than allowed",
     "look at load and drives", "technician", "W"},
    {kCauseStall, "stall", "a wheel stands although its target is not zero",
     "free the wheel, or look at its motor and encoder", "technician", "rad"},
    {kCauseRunaway, "runaway", "a wheel is faster than its target",
     "look at slope and load, motor and encoder of that wheel", "technician", "rad/s"},
    {kCauseWrongDirection, "wrong_direction", "a wheel turns against its target",
     "look at the wiring of its motor and encoder", "technician", "rad/s"},
    {kCauseNotStopping, "not_stopping", "the robot still moves although it is commanded to stand",
     "find out what pushes it; check slope, motors and encoders", "technician", "s"},
    {kCauseYawRate, "yaw_rate", "gyro and wheels disagree on how fast the robot turns",
     "look at gyro, encoders and grip of the wheels", "technician", "rad/s"},
    {kCauseTilt, "tilt", "the robot is tilted too far",
     "set it upright on level ground; where it stands so, look at the IMU", "operator", "rad"},
    {kCauseTipOver, "tip_over", "the robot was tipping over",
     "set it upright, lower load or speed", "operator", "rad/s"},
    {kCauseFreeFall, "free_fall", "the robot was falling",
     "look at the robot", "operator", "m/s²"},
    {kCauseLift, "lift", "the wheels carry too little of the robot's weight",
     "set it down on its wheels", "operator", "of its weight"},
    {kCauseImpact, "impact", "the robot hit something",
     "look what it hit; where nothing was, at the IMU", "operator", "m/s²"},
    {kCauseGateRefuses, "gate_refuses", "the gate brakes in spite of the permit, or refuses frames",
     "read the gate's reasons in /diagnostics", "integrator", "cycles"},
    {kCauseGateDisobeys, "gate_disobeys", "the gate let a command pass in spite of the permit",
     "use the hardware emergency stop; repair the driver", "integrator", "cycles"},
    {kCauseOverruns, "overruns", "the driver often ends its cycle too late",
     "grant real-time privileges, keep other work off its core", "integrator", "1/s"},
    {kCauseBatteryLow, "battery_low", "the battery is low", "charge it soon", "operator", "V"},
    {kCauseBatteryEmpty, "battery_empty", "the battery is empty", "charge it", "operator", "V"},
    {kCauseLatchUnreadable, "latch_unreadable", "the record of an earlier stop cannot be read",
     "look at the robot and at latch_file", "operator"},
    {kCauseTorqueOscillation, "torque_oscillation", "a motor pulls to and fro far more than the motion asks for",
     "lower pid_kp, pid_ki and tracking_bandwidth, or leave them out; look for delays and play of that drive", "integrator", "of its limit"},
});
// clang-format on

}  // namespace robot_control
