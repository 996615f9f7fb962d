#pragma once
/// The reader's end of a node's snapshots.

#include <cstddef>
#include <optional>
#include <string>

#include "hal/bus.h"
#include "runtime/cycles/trace_sink.h"
#include "signals/law_snapshot.h"

namespace robot_control {

class SnapshotSource {
 public:
  SnapshotSource(const std::string& bus, TraceRing ring)
      : channel_(bus, kSnapshotChannels[static_cast<std::size_t>(ring)]) {}

  /// Ordinary thread, at 10 Hz: maps the ring when it appears or is replaced. All that is in it is new.
  void poll() {
    if (channel_.poll()) reader_.emplace(channel_.memory(), 0);
  }

  /// The next one, sealed; false: there is none yet.
  bool take(LawSnapshot& snapshot) {
    if (!reader_ || !reader_->take(snapshot)) return false;
    seal(snapshot);
    return true;
  }

 private:
  ForeignChannel<SnapshotRing> channel_;
  std::optional<SnapshotReader> reader_;
};

}  // namespace robot_control
