#pragma once
/// UnitreeLeggedLine are the statements of the drive file about the low level of a Unitree Go1.

#include <string>
#include <vector>

#include "drivers/unitree/unitree_parameters.h"

namespace robot_control {

/// Robots of the maker whose low level is UDP. A1 and Aliengo are known so that their refusal states the reason.
enum class LeggedRobot : std::uint8_t { kGo1, kA1, kAliengo };

inline std::vector<Word> words_of(LeggedRobot) {
  return {{"go1", LeggedRobot::kGo1}, {"a1", LeggedRobot::kA1}, {"aliengo", LeggedRobot::kAliengo}};
}

/// s without a new state, after which the driver stops: 20 ms from the last one on, in cycles of 2 ms. A line that
/// loses 5 % of the datagrams each way is silent for so long once in 1000 times 30 minutes.
inline constexpr double kLeggedSilence = 0.018;

struct UnitreeLeggedLine {
  LeggedRobot robot = LeggedRobot::kGo1;
  std::string address;                  ///< of the robot's low level: IPV4:PORT
  std::uint64_t port = 8080;            ///< of this computer
  double min_charge = 10;               ///< %, of the battery
  double max_silence = kLeggedSilence;  ///< s

  /// The reaction of the robot to a host that is silent, which cannot be read.
  SilenceReaction on_silence = SilenceReaction::kUnknown;
};

inline Keys keys(UnitreeLeggedLine& line) {
  return {
      {"robot", &line.robot},
      {"address", &line.address},
      {"port", &line.port, {}, 1024, 65535, kOptional},
      {"min_charge", &line.min_charge, "%", 0, 90, kOptional},
      {"max_silence", &line.max_silence, "s", 0.004, kLeggedSilence, kOptional},
      {"on_silence", &line.on_silence},
  };
}

}  // namespace robot_control
