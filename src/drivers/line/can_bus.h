#pragma once
/// A CanBus sends and receives frames in batches through a CanSocket. After construction it neither blocks nor
/// allocates nor throws, and it reads no clock: the caller states the time.
///
/// A frame that the kernel accepted is sent; whether another node acknowledged it is not known. The controller repeats
/// a corrupted frame by itself. A loss therefore shows as silence, as a full queue, or as an error frame, from which
/// the state of the controller is read. In a folder (can_socket.h) a party that joins is found within kPartySearchNs.

#include <sys/socket.h>
#include <sys/uio.h>

#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <span>

#include "drivers/line/can_frame.h"
#include "drivers/line/can_socket.h"

namespace robot_control {

inline constexpr std::size_t kMaxDatagrams = 32;  ///< received by one call
inline constexpr std::int64_t kPartySearchNs = 100'000'000;

/// The time of one call on two clocks, ns. Time stamps of the kernel are on CLOCK_REALTIME.
struct CanTime {
  std::int64_t time_ns = 0;  ///< CLOCK_MONOTONIC
  std::int64_t utc_ns = 0;   ///< CLOCK_REALTIME
};

struct ReceivedFrame {
  can_frame frame{};
  std::int64_t stamp_ns = 0;  ///< when the kernel received it, on CLOCK_MONOTONIC
};

/// Fault confinement of ISO 11898-1, 12.1: the state that the controller's error frames reported last.
enum class CanState : std::uint8_t {
  kActive,
  kWarning,  ///< an error counter exceeds 96
  kPassive,  ///< an error counter exceeds 127
  kBusOff,   ///< The controller takes no part in the bus until it is restarted.
};

/// Numbers since construction, of frames unless stated otherwise.
struct CanCounts {
  std::uint64_t sent = 0;
  std::uint64_t received = 0;   ///< data frames and remote requests that passed a filter
  std::uint64_t refused = 0;    ///< not sent, most often because the queue to the controller was full (ENOBUFS)
  std::uint64_t lost = 0;       ///< dropped because a queue was full: this receiver's, or that of a party of a folder
  std::uint64_t malformed = 0;  ///< datagrams that hold no whole frames, and frames that are too long
  std::uint64_t errors = 0;     ///< system calls that failed for another reason than a full queue
  std::uint64_t error_frames = 0;  ///< reported by the controller
  std::uint64_t bus_off = 0;       ///< changes to CanState::kBusOff
};

struct ReceivedFrames {
  std::span<const ReceivedFrame> frames;  ///< in the order of reception, valid until the next call
  bool more = false;                      ///< the kernel may hold further frames
};

class CanBus {
 public:
  explicit CanBus(CanSocket socket) noexcept;
  CanBus(const CanBus&) = delete;
  CanBus& operator=(const CanBus&) = delete;

  /// Sends the frames in their order. Returns how many were sent: sent + refused is the number of frames passed to it.
  /// A folder without another party refuses, as a bus on which no node acknowledges.
  std::size_t send(std::span<const can_frame> frames) noexcept;

  /// Returns the frames of at most kMaxDatagrams datagrams, without error frames. A stamp lies between the last call
  /// that left nothing and this one, also when CLOCK_REALTIME jumped.
  ReceivedFrames receive(const CanTime& now) noexcept;

  CanState state() const noexcept { return state_; }
  const CanCounts& counts() const noexcept { return counts_; }

  /// Returns the last frame that `error_frames` counts (bus_watch.h); one without an identifier: there was none.
  const can_frame& last_error_frame() const noexcept { return last_error_frame_; }

 private:
  /// The bytes of a datagram, in which the frames follow each other with their transfer_size.
  using Frames = std::array<std::byte, kMaxFramesPerDatagram * kFdFrameBytes>;
  using Parts = std::array<iovec, kMaxFramesPerDatagram>;

  struct Sent {
    std::size_t frames = 0;
    int error = 0;  // why not all were sent
  };

  Sent send_part(std::span<const can_frame> frames) noexcept;
  Sent send_together(std::span<const can_frame> frames) noexcept;
  Sent send_singly(std::span<const can_frame> frames) noexcept;
  Sent send_to_parties(std::span<const can_frame> frames) noexcept;
  void accept(std::span<const std::byte> datagram, std::int64_t stamp_ns) noexcept;
  void evaluate_error_frame(const can_frame& frame) noexcept;
  std::int64_t stamp_of(msghdr& head, const CanTime& now) noexcept;
  void count_dropped(msghdr& head) noexcept;

  CanSocket socket_;
  CanState state_ = CanState::kActive;
  CanCounts counts_;
  can_frame last_error_frame_{};
  std::bitset<kMaxParties> present_;  // parties that may be there
  std::int64_t searched_ns_ = 0;
  std::int64_t emptied_ns_ = 0;  // the last call of `receive` that left nothing
  std::uint32_t dropped_ = 0;    // the kernel's own count of frames that did not fit into the queue
  std::array<Frames, kMaxDatagrams> datagrams_{};
  std::array<ReceivedFrame, kMaxDatagrams * kMaxFramesPerDatagram> received_{};
  std::size_t received_count_ = 0;
};

}  // namespace robot_control
