#pragma once
/// UnitreeGoLine are the statements of the drive file about the low level of a Unitree Go2 or B2, and about the program
/// unitree_bridge before it.

#include <string>
#include <vector>

#include "drivers/unitree/unitree_parameters.h"

namespace robot_control {

enum class GoRobot : std::uint8_t { kGo2, kB2 };

inline std::vector<Word> words_of(GoRobot) {
  return {{"go2", GoRobot::kGo2}, {"b2", GoRobot::kB2}};
}

/// s without a new state, after which the driver stops. From a loss on it is 20 ms, with 2 ms of a state under way and
/// a cycle of 2 ms. A Go2 sends without being asked, so its line is silent for so long more rarely than that of a Go1.
inline constexpr double kGoSilence = 0.016;

struct UnitreeGoLine {
  GoRobot robot = GoRobot::kGo2;
  std::string interface = "lo";            ///< network interface to the robot
  std::uint64_t domain = 0;                ///< of DDS
  std::string address = "127.0.0.1:8117";  ///< of unitree_bridge: IPV4:PORT on this computer
  std::uint64_t port = 8118;               ///< UDP port of the driver
  bool has_service = true;                 ///< The robot has a motion service; a simulator may have none.
  bool release_service = false;            ///< The bridge may release it.
  std::uint64_t other_writers = 0;         ///< of rt/lowcmd, which never send
  double damping = 3;                      ///< N·m·s/rad, by which the bridge folds the legs without a driver
  double min_charge = 10;                  ///< %, of the battery
  double max_silence = kGoSilence;         ///< s

  /// The reaction of the robot to a host that is silent, which cannot be read.
  SilenceReaction on_silence = SilenceReaction::kUnknown;
};

inline Keys keys(UnitreeGoLine& line) {
  return {
      {"robot", &line.robot},
      {"interface", &line.interface, {}, 0, 0, kOptional},
      {"domain", &line.domain, {}, 0, 230, kOptional},
      {"address", &line.address, {}, 0, 0, kOptional},
      {"port", &line.port, {}, 1024, 65535, kOptional},
      {"has_service", &line.has_service, {}, 0, 0, kOptional},
      {"release_service", &line.release_service, {}, 0, 0, kOptional},
      {"other_writers", &line.other_writers, {}, 0, 100, kOptional},
      {"damping", &line.damping, "N·m·s/rad", 0.1, 100, kOptional},
      {"min_charge", &line.min_charge, "%", 0, 90, kOptional},
      {"max_silence", &line.max_silence, "s", 0.004, kGoSilence, kOptional},
      {"on_silence", &line.on_silence},
  };
}

}  // namespace robot_control
