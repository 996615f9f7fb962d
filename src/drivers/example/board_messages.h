#pragma once
/// The messages of the example's motor board, which takes the torques of up to kMaxJoints motors. It brakes by itself
/// kBoardWatchdogNs after the last order. One datagram holds one message; SI units, the joint's own sign.

#include <array>
#include <cstdint>

#include "signals/joint.h"

namespace robot_control {

inline constexpr std::uint32_t kBoardOrderHead = 0x524F4231;   ///< "ROB1"
inline constexpr std::uint32_t kBoardReportHead = 0x524F4232;  ///< "ROB2"
inline constexpr std::int64_t kBoardWatchdogNs = 20'000'000;

struct BoardOrder {
  std::uint32_t head = kBoardOrderHead;
  std::uint32_t count = 0;
  std::array<double, kMaxJoints> torque{};
};

struct BoardReport {
  struct Motor {
    double position = 0;
    double velocity = 0;
    double torque = 0;
    std::uint64_t fault = 0;  ///< 0: none
  };
  std::uint32_t head = kBoardReportHead;
  std::uint32_t count = 0;
  std::array<Motor, kMaxJoints> motors{};
};

}  // namespace robot_control
