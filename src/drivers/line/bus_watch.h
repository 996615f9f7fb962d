#pragma once
/// A BusWatch judges a bus by what its controller reports and by what it carried in the last kRecentNs.
///
///   starting   no frame was received yet
///   up         frames are received
///   degraded   the controller reported errors, or a frame was not sent because the queue was full
///   down       the controller is bus-off, or no frame at all was received in this time
///
/// A cable that is out and a wrong bit rate show themselves as silence, most often with error frames or a full queue.

#include <algorithm>
#include <cstdint>
#include <string>

#include "drivers/line/can_bus.h"
#include "drivers/line/can_frame.h"
#include "signals/sensor_frame.h"

namespace robot_control {

/// Error frames of a CAN controller in words, for messages. Source: linux/can/error.h.
///
/// Returns everything that the frame reports, separated by commas; "" of a frame without an identifier.
std::string can_error_words(const can_frame& error);

/// A copy of it may be put into words by another thread.
struct BusStatus {
  LinkState state = LinkState::kStarting;
  bool bus_off = false;
  bool silent = false;      ///< No frame was received.
  bool queue_full = false;  ///< A frame was not sent.
  can_frame error{};        ///< the last error frame; one without an identifier: there was none

  bool operator==(const BusStatus& other) const noexcept {
    return state == other.state && bus_off == other.bus_off && silent == other.silent &&
           queue_full == other.queue_full && error.can_id == other.error.can_id &&
           std::ranges::equal(error.data, other.error.data);
  }
};

class BusWatch {
 public:
  static constexpr std::int64_t kRecentNs = 1'500'000'000;  ///< fifteen heartbeats at their usual 0.1 s

  /// Runs once per cycle, after the frames were received.
  void step(const CanBus& bus, std::int64_t now_ns) noexcept;
  const BusStatus& status() const noexcept { return status_; }

 private:
  /// A count, and when it has last grown.
  struct Growth {
    std::uint64_t count = 0;
    std::int64_t last_ns = 0;

    bool recent(std::uint64_t now, std::int64_t now_ns) noexcept {
      if (now != count) last_ns = now_ns;
      count = now;
      return count != 0 && now_ns - last_ns < kRecentNs;
    }
  };

  BusStatus status_;
  std::int64_t began_ns_ = -1;  // time of the first step; −1: none yet
  Growth received_, refused_, errors_;
};

/// Returns what is wrong with the bus, and the remedies; "" if nothing is.
std::string words(const BusStatus& status);

}  // namespace robot_control
