#pragma once
/// A node's end of the trace: one row per step of its law into its ring.
///
/// While a telemetry reads, a full ring blocks its writer, and so the cycle, in lockstep. In wall-clock time the
/// new row is dropped and counted. With no telemetry the oldest rows are overwritten. Beside them go the snapshots of
/// the law, of which a ring holds the last eight.

#include <atomic>
#include <cstdint>
#include <string>

#include "bus/bus.h"
#include "bus/ring.h"
#include "signals/law_snapshot.h"

namespace robot_control {

/// Channel of each ring of snapshots; one that was not read is overwritten by the eighth after it.
inline constexpr const char* kSnapshotChannels[kTraceRings] = {"snapshot_plant", "snapshot_estimator",
                                                               "snapshot_controller", "snapshot_monitor"};
using SnapshotRing = Ring<LawSnapshot, std::atomic, 8>;
using SnapshotWriter = RingWriter<LawSnapshot, std::atomic, 8>;
using SnapshotReader = RingReader<LawSnapshot, std::atomic, 8>;

template <class Row>
class TraceSink {
 public:
  TraceSink(const std::string& bus, TraceRing ring, bool lockstep)
      : channel_(bus, kTraceChannels[static_cast<std::size_t>(ring)]),
        writer_(channel_.memory()),
        snapshot_channel_(bus, kSnapshotChannels[static_cast<std::size_t>(ring)]),
        snapshot_writer_(snapshot_channel_.memory()),
        positions_(bus, ChannelNames::kTraceRead),
        ring_(static_cast<std::size_t>(ring)),
        lockstep_(lockstep) {
    writer_.begin();
  }

  /// Ordinary thread, at 10 Hz: searches for a telemetry that has mapped all rings.
  void poll() {
    positions_.poll();
    const RingPositions* memory = positions_.memory();
    const bool reads = memory != nullptr && positions_.locked() && memory->head.attached_run.load() != 0;
    read_.store(reads ? &memory->read[ring_] : nullptr, std::memory_order_release);
  }

  /// Ordinary thread: this thread appends, and may be watched by others.
  void announce_thread(int id) noexcept {
    channel_.memory()->thread.store(static_cast<std::uint64_t>(id), std::memory_order_release);
  }

  bool reader_present() const noexcept { return read_.load(std::memory_order_acquire) != nullptr; }

  /// `snapshot`: of the law before this row, or null.
  void append(const Row& row, const LawSnapshot* snapshot, const std::atomic<bool>& stop) noexcept {
    if (snapshot != nullptr) snapshot_writer_.append(*snapshot, nullptr);
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
  OwnedChannel<SnapshotRing> snapshot_channel_;
  SnapshotWriter snapshot_writer_;
  ForeignChannel<RingPositions> positions_;
  std::size_t ring_;
  bool lockstep_;
  std::atomic<const std::atomic<std::uint64_t>*> read_{nullptr};
};

}  // namespace robot_control
