#pragma once
/// Messages that both firmwares, 0.5 and 0.6, have. Positions, velocities and torques are of the motor's shaft.

#include <numbers>

#include "drivers/odrive/odrive_codec.h"

namespace robot_control::odrive {

inline constexpr double kTurn = 2 * std::numbers::pi;  ///< rad

enum class AxisState : std::uint32_t {
  kUndefined = 0,
  kIdle = 1,  ///< The motor is released: the axis coasts.
  kClosedLoopControl = 8,
};

enum class ControlMode : std::uint32_t { kTorque = 1, kVelocity = 2, kPosition = 3 };

enum class InputMode : std::uint32_t { kPassthrough = 1 };

/// The axis stops with the error ESTOP_REQUESTED.
struct Estop {
  static constexpr Command kCommand = to_axis(0x02);

  static constexpr auto layout() { return std::tuple{}; }
};

struct SetAxisState {
  static constexpr Command kCommand = to_axis(0x07);
  AxisState state = AxisState::kIdle;

  static constexpr auto layout() { return std::tuple{wire_unsigned(&SetAxisState::state, 0, 32)}; }
};

struct EncoderEstimates {
  static constexpr Command kCommand = from_axis(0x09);
  double position = 0;  ///< rad
  double velocity = 0;  ///< rad/s

  static constexpr auto layout() {
    return std::tuple{wire_float(&EncoderEstimates::position, 0, kTurn),
                      wire_float(&EncoderEstimates::velocity, 32, kTurn)};
  }
};

struct SetControllerMode {
  static constexpr Command kCommand = to_axis(0x0B);
  ControlMode control = ControlMode::kTorque;
  InputMode input = InputMode::kPassthrough;

  static constexpr auto layout() {
    return std::tuple{wire_unsigned(&SetControllerMode::control, 0, 32),
                      wire_unsigned(&SetControllerMode::input, 32, 32)};
  }
};

struct SetInputVelocity {
  static constexpr Command kCommand = to_axis(0x0D);
  double velocity = 0;  ///< rad/s
  double torque = 0;    ///< feed-forward, N·m

  static constexpr auto layout() {
    return std::tuple{wire_float(&SetInputVelocity::velocity, 0, kTurn), wire_float(&SetInputVelocity::torque, 32)};
  }
};

/// The axis keeps the last value and applies it when it enters closed loop the next time.
struct SetInputTorque {
  static constexpr Command kCommand = cyclic_to_axis(0x0E);
  double torque = 0;  ///< N·m

  static constexpr auto layout() { return std::tuple{wire_float(&SetInputTorque::torque, 0)}; }
};

struct SetLimits {
  static constexpr Command kCommand = to_axis(0x0F);
  double velocity = 0;  ///< rad/s
  double current = 0;   ///< A

  static constexpr auto layout() {
    return std::tuple{wire_float(&SetLimits::velocity, 0, kTurn), wire_float(&SetLimits::current, 32)};
  }
};

/// Torque = current · torque constant of the motor.
struct Iq {
  static constexpr Command kCommand = from_axis(0x14);
  double setpoint = 0;  ///< A
  double measured = 0;  ///< A

  static constexpr auto layout() { return std::tuple{wire_float(&Iq::setpoint, 0), wire_float(&Iq::measured, 32)}; }
};

struct BusVoltageCurrent {
  static constexpr Command kCommand = from_axis(0x17);
  double voltage = 0;  ///< V
  double current = 0;  ///< A

  static constexpr auto layout() {
    return std::tuple{wire_float(&BusVoltageCurrent::voltage, 0), wire_float(&BusVoltageCurrent::current, 32)};
  }
};

struct SetVelocityGains {
  static constexpr Command kCommand = to_axis(0x1B);
  double gain = 0;        ///< N·m/(rad/s)
  double integrator = 0;  ///< N·m/rad

  static constexpr auto layout() {
    return std::tuple{wire_float(&SetVelocityGains::gain, 0, 1 / kTurn),
                      wire_float(&SetVelocityGains::integrator, 32, 1 / kTurn)};
  }
};

}  // namespace robot_control::odrive
