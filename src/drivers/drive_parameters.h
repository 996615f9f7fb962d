#pragma once
/// DriveParameters are common to all dialects: bus and node of a drive, its place at the joint, its limits, and its
/// reaction on silence.

#include <cstdint>
#include <string>

#include "parameters/block.h"

namespace robot_control {

/// The reaction of a drive that receives no frame any more.
enum class SilenceReaction : std::uint8_t {
  kUnknown,  ///< It may keep its last torque for ever.
  kCoasts,   ///< The motor is released; on a slope the joint moves.
  kBrakes,   ///< The drive slows the joint down, and then releases the motor.
  kHolds,    ///< The drive slows the joint down, and then holds it.
  kKeeps,    ///< The drive keeps its last order for ever.
};

inline std::vector<Word> words_of(SilenceReaction) {
  return {{"unknown", SilenceReaction::kUnknown},
          {"coasts", SilenceReaction::kCoasts},
          {"brakes", SilenceReaction::kBrakes},
          {"holds", SilenceReaction::kHolds},
          {"keeps", SilenceReaction::kKeeps}};
}

/// Returns what the drive does on silence, in words.
inline std::string described(SilenceReaction reaction) {
  if (reaction == SilenceReaction::kUnknown) return "does what is unknown";
  return word_of(reaction) + (reaction == SilenceReaction::kKeeps ? " its last order for ever" : "");
}

struct DriveParameters {
  static constexpr const char *kPlace = "node", *kMotor = "drive";

  std::string joint;               ///< name in the robot's model; the name of the block
  std::string bus{};               ///< address of its bus (can_socket.h)
  std::uint64_t node = 0;          ///< of the drive on the bus
  std::int64_t direction = 1;      ///< 1 or −1: the joint turns with the motor, or against it
  double gear = 1;                 ///< turns of the motor per turn of the joint, or per metre
  double torque_limit = 0;         ///< N·m or N, of the joint
  double velocity_limit = 0;       ///< rad/s or m/s, of the joint
  double max_temperature = 90;     ///< °C
  double min_voltage = 0;          ///< V; 0: not judged
  bool takes_speeds = false;       ///< The drive closes the loop of its speed (robot.wheel_command).
  bool takes_effort = false;       ///< beside a speed: it adds the torque of the command (kTakesEffort)
  bool measures_torque = true;     ///< else the effort is not known
  bool effort_is_rare = false;     ///< The torque is measured more rarely than in each cycle.
  bool is_absolute = false;        ///< Its zero is that of the joint, moved by `offset`, at each power-on.
  double offset = 0;               ///< rad, angle of the joint where an absolute drive reports 0
  double max_stiffness = 0;        ///< N·m/rad, of the joint, of an impedance that the drive closes; 0: it closes none
  double max_damping = 0;          ///< N·m·s/rad, likewise
  double position_step = 0;        ///< rad of the motor, by which a coarse position may move at rest
  double sample_period = 0;        ///< s between positions that the drive sends by itself; 0: one in each cycle
  std::uint64_t max_silence = 20;  ///< samples in a row that may be missing

  /// The reaction that the user found by experiment, where the drive cannot be asked.
  SilenceReaction on_silence = SilenceReaction::kUnknown;
  bool accept_unknown_watchdog = false;  ///< The joint may move although its reaction is unknown.
};

inline Keys keys(DriveParameters& drive) {
  return {
      {"bus", &drive.bus, {}, 0, 0, kOptional},
      {"node", &drive.node, {}, 0, 254},
      {"direction", &drive.direction, {}, -1, 1, kOptional},
      {"gear", &drive.gear, "turns of the motor per turn of the joint", 1.0e-3, 1.0e5, kOptional},
      {"torque_limit", &drive.torque_limit, "N·m", 1.0e-3, 1.0e4},
      {"velocity_limit", &drive.velocity_limit, "rad/s", 0.01, 1000},
      {"max_temperature", &drive.max_temperature, "°C", 20, 200, kOptional},
      {"min_voltage", &drive.min_voltage, "V", 0, 1000, kOptional},
      {"max_silence", &drive.max_silence, "samples", 3, 1000, kOptional},
      {"on_silence", &drive.on_silence, {}, 0, 0, kOptional},
      {"accept_unknown_watchdog", &drive.accept_unknown_watchdog, {}, 0, 0, kOptional},
  };
}

}  // namespace robot_control
