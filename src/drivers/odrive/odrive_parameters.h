#pragma once
/// OdriveParameters are the statements of the drive file about one ODrive axis.

#include <cstdint>
#include <vector>

#include "drivers/drive_parameters.h"

namespace robot_control::odrive {

enum class Firmware : std::uint8_t {
  kAny,  ///< A drive that answers Get_Version has 0.6, another one 0.5.
  k05,
  k06,
};

inline std::vector<Word> words_of(Firmware) {
  return {{"any", Firmware::kAny}, {"0.5", Firmware::k05}, {"0.6", Firmware::k06}};
}

struct OdriveParameters {
  DriveParameters drive{};
  Firmware firmware = Firmware::kAny;
  std::uint64_t serial_number = 0;    ///< 0.6 alone; 0: not compared
  double torque_constant = 0;         ///< N·m/A, of the motor
  double motor_velocity_limit = 0;    ///< rad/s, at which the drive reduces its torque; 0: 1.5 · that of the joint
  double heartbeat_period = 0.1;      ///< s, as set in the drive
  double estimates_period = 0;        ///< s, as set in the drive; 0: requested in each cycle
  double effort_period = 0;           ///< s between torques, as set in the drive; 0: requested
  double effort_rate = 100;           ///< Hz of requests for the torque, where the drive does not send it by itself
  double counts_per_turn = 8192;      ///< of the encoder; with 0.5, to set the position
  double max_position_step = 1.0e-3;  ///< rad of the motor; above it the zero moves at the next rest

  /// Numbers in the endpoint list of exactly this firmware (0.6); 0: the watchdog cannot be read.
  std::uint64_t enable_watchdog_endpoint = 0;
  std::uint64_t watchdog_timeout_endpoint = 0;
  double max_watchdog_timeout = 0.2;  ///< s; a longer one that is read refuses

  std::uint64_t place() const noexcept { return drive.node; }
};

inline Keys keys(OdriveParameters& p) {
  return joined({keys(p.drive),
                 {
                     {"firmware", &p.firmware, {}, 0, 0, kOptional},
                     {"serial_number", &p.serial_number, {}, 0, 281474976710655.0, kOptional},
                     {"torque_constant", &p.torque_constant, "N·m/A", 1.0e-4, 100},
                     {"motor_velocity_limit", &p.motor_velocity_limit, "rad/s", 0.01, 1.0e5, kOptional | kZeroIsOff},
                     {"heartbeat_period", &p.heartbeat_period, "s", 0.001, 1, kOptional},
                     {"estimates_period", &p.estimates_period, "s", 0.001, 1, kOptional | kZeroIsOff},
                     {"effort_period", &p.effort_period, "s", 0.001, 1, kOptional | kZeroIsOff},
                     {"effort_rate", &p.effort_rate, "Hz", 1, 2000, kOptional},
                     {"counts_per_turn", &p.counts_per_turn, {}, 1, 1.0e8, kOptional},
                     {"max_position_step", &p.max_position_step, "rad", 1.0e-6, 1, kOptional},
                     {"enable_watchdog_endpoint", &p.enable_watchdog_endpoint, {}, 0, 65535, kOptional},
                     {"watchdog_timeout_endpoint", &p.watchdog_timeout_endpoint, {}, 0, 65535, kOptional},
                     {"max_watchdog_timeout", &p.max_watchdog_timeout, "s", 0.001, 10, kOptional},
                 }});
}

}  // namespace robot_control::odrive
