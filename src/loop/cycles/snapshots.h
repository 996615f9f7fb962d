#pragma once
/// The copies of a law's state: one of 2 … 30 KB, about a microsecond, every kSnapshotCycles.

#include <cstdint>

#include "loop/build_id.h"
#include "signals/law_calls.h"
#include "signals/law_snapshot.h"

namespace robot_control {

class Snapshots {
 public:
  explicit Snapshots(LawName law) noexcept {
    snapshot_.law = law;
    snapshot_.build = build_id();
  }

  /// Called before the law's step of the cycle in `head`; `noted` is the row of that step. Without checksums of frames
  /// (FrameWriter::seals) there is no replay, and nothing is copied.
  template <class Law>
  void copy_if_due(const Law& law, const LawRow& noted, const FrameHead& head, bool seals) noexcept {
    constexpr std::uint64_t kFirstRows = 2;  // the first one repeats a cycle of an earlier process, perhaps
    const std::uint64_t part = head.cycle / kSnapshotCycles;
    taken_ = noted.number < kFirstRows || noted.new_run != 0 || part != part_;
    part_ = part;
    taken_ = taken_ && seals;
    if (!taken_) return;
    snapshot_.head = {.run = head.run, .cycle = head.cycle, .stamp_ns = head.stamp_ns};
    snapshot_.process = noted.process;
    snapshot_.number = noted.number;
    save_state(law, snapshot_);
  }

  /// The copy taken in the last step; null: none was due.
  const LawSnapshot* taken() const noexcept { return taken_ ? &snapshot_ : nullptr; }

 private:
  std::uint64_t part_ = 0;  ///< of the run, of kSnapshotCycles each
  bool taken_ = false;
  LawSnapshot snapshot_;
};

}  // namespace robot_control
