#pragma once
/// A LinkStatus counts what a link between the driver and its drives and sensors carried: a bus, or a serial line.

#include <cstddef>
#include <cstdint>

namespace robot_control {

inline constexpr std::size_t kMaxLinks = 4;

enum class LinkState : std::uint64_t {
  kStarting = 0,
  kUp = 1,
  kDegraded = 2,  ///< It still carries messages, but reports errors, as a CAN controller that is error-passive.
  kDown = 3,      ///< It carries nothing: unplugged, or a CAN controller that is bus-off.
};

/// The counters belong to the present run.
struct LinkStatus {
  LinkState state = LinkState::kStarting;
  std::uint64_t sent = 0;    ///< messages
  std::uint64_t lost = 0;    ///< expected answers that never came
  std::uint64_t late = 0;    ///< answers that came after the cycle in which they were due
  std::uint64_t errors = 0;  ///< errors that the link itself reported
};

}  // namespace robot_control
