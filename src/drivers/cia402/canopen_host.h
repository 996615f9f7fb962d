#pragma once
/// The CanopenHost sends to all CANopen nodes of a bus: SYNC in each cycle, after the torques, and its heartbeat.

#include <cstdint>

#include "drivers/cia402/canopen.h"
#include "drivers/drive/drive.h"

namespace robot_control::canopen {

class CanopenHost {
 public:
  /// A drive reacts after `timeout` s without a heartbeat. Ten are sent in that time, so that a few may be lost.
  CanopenHost(std::uint8_t node, double timeout) noexcept
      : node_(node), heartbeat_ns_(static_cast<std::int64_t>(1.0e9 * timeout / kHeartbeats)) {}

  void step(std::int64_t now_ns, FrameBatch& send) noexcept {
    send.add(sync_frame());
    if (now_ns < next_ns_) return;
    next_ns_ = now_ns + heartbeat_ns_;
    send.add(encode_heartbeat({.node = node_, .state = NmtState::kOperational}));
  }

  static PlannedFrames planned_sync() noexcept { return {.data_bytes = 0, .per_cycle = 1}; }
  PlannedFrames planned_heartbeat() const noexcept {
    return {.data_bytes = 1, .per_second = 1.0e9 / static_cast<double>(heartbeat_ns_)};
  }

 private:
  static constexpr int kHeartbeats = 10;
  std::uint8_t node_;
  std::int64_t heartbeat_ns_;
  std::int64_t next_ns_ = 0;
};

}  // namespace robot_control::canopen
