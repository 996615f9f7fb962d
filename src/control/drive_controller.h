#pragma once
/// diff_drive_controller's chain in one step: request → limits → kinematics → wheel loops → torque.

#include <cstdint>

#include "robot/robot_model.h"
#include "signals/command_frame.h"
#include "signals/permit.h"
#include "signals/sensor_frame.h"
#include "signals/state_frame.h"
#include "signals/velocity_command.h"

namespace robot_control {

struct DriveControllerParameters {
  double max_linear_speed = 1.0;          ///< m/s
  double max_angular_speed = 2.0;         ///< rad/s
  double max_linear_acceleration = 1.0;   ///< m/s²
  double max_angular_acceleration = 4.0;  ///< rad/s²
  double cmd_vel_timeout = 1.25;          ///< s; 0 = never
  double pid_kp = 2.0;                    ///< N·m·s/rad
  double pid_ki = 10.0;                   ///< N·m/rad
  double pid_kd = 0.0;                    ///< N·m·s²/rad
  double tracking_bandwidth = 20.0;       ///< Hz, of the wheel speed's tracking loop
};

/// Everything that one cycle depends on. Null: not available in this cycle.
struct ControlInput {
  const SensorFrame* sensors = nullptr;  ///< never null
  const StateFrame* state = nullptr;
  const Permit* permit = nullptr;        ///< the newest unexpired one ≤ k-1
  VelocityCommand request;               ///< the inbox; a new message is one with a new count
};

class DriveController {
 public:
  DriveController(const DriveControllerParameters& parameters, const RobotModel& robot, double period);

  /// A new run: forgets requests (`request_count` is the inbox's count now) and every state.
  void reset(std::uint64_t request_count) noexcept;

  /// Fills everything but `out.head`.
  void step(const ControlInput& input, CommandFrame& out) noexcept;
};

}  // namespace robot_control
