#pragma once
/// A node's end of the trace: one row per cycle into its ring.
///
/// While a telemetry reads, a full ring blocks its writer, and so the cycle, in lockstep; in wall-clock time the
/// new row is dropped and counted. With no telemetry the oldest rows are overwritten.

#include <atomic>
#include <cstdint>
#include <string>

#include "hal/bus.h"
#include "rt/ring.h"

namespace robot_control {

/// Channel of each ring, by TraceRing.
inline constexpr const char* kTraceChannels[kTraceRings] = {"trace_plant", "trace_estimator", "trace_controller",
                                                            "trace_monitor"};

template <class Row>
class TraceSink {
 public:
  TraceSink(const std::string& bus, TraceRing ring, bool lockstep)
      : channel_(bus, kTraceChannels[static_cast<std::size_t>(ring)]),
        writer_(channel_.memory()),
        positions_(bus, ChannelNames::kTraceRead),
        ring_(static_cast<std::size_t>(ring)),
        lockstep_(lockstep) {}

  /// Ordinary thread, at 10 Hz: is a telemetry there, and has it mapped all rings?
  void poll() {
    positions_.poll();
    const RingPositions* memory = positions_.memory();
    const bool reads = memory != nullptr && positions_.locked() && memory->head.attached_run.load() != 0;
    read_.store(reads ? &memory->read[ring_] : nullptr, std::memory_order_release);
  }

  bool reader_present() const noexcept { return read_.load(std::memory_order_acquire) != nullptr; }

  void append(const Row& row, const std::atomic<bool>& stop) noexcept {
    constexpr std::int64_t kRetry = 50'000;  // ns; lockstep only, where nothing is real-time
    const std::atomic<std::uint64_t>* read = read_.load(std::memory_order_acquire);
    while (lockstep_ && writer_.full(read) && !stop.load()) {
      sleep_ns(kRetry);
      read = read_.load(std::memory_order_acquire);
    }
    writer_.append(row, read);
  }

 private:
  OwnedChannel<Ring<Row>> channel_;
  RingWriter<Row> writer_;
  ForeignChannel<RingPositions> positions_;
  std::size_t ring_;
  bool lockstep_;
  std::atomic<const std::atomic<std::uint64_t>*> read_{nullptr};
};

}  // namespace robot_control
