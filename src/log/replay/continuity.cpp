#include "log/replay/continuity.h"

#include "loop/build_id.h"
#include "signals/checksum.h"

namespace robot_control {

bool SnapshotStore::add(const LawSnapshot& snapshot) {
  if (!intact(snapshot)) return false;
  if (snapshot.build != build_id()) {
    throw ReplayError("the log is of build " + hex(snapshot.build) + ", this is build " + hex(build_id()) +
                      ": replay with the build that made the log");
  }
  snapshots_.insert_or_assign({snapshot.law, snapshot.process, snapshot.number}, snapshot);
  return true;
}

const LawSnapshot* SnapshotStore::find(LawName law, const LawRow& row) const {
  const auto found = snapshots_.find({law, row.process, row.number});
  return found == snapshots_.end() ? nullptr : &found->second;
}

void Continuity::pass_over(std::int64_t run, std::uint64_t cycle) {
  ++report().not_compared;
  if (gap_ != 0) {
    ReplayGap& gap = report_.gaps[gap_ - 1];
    if (gap.run == run && gap.reason == reason_) {
      gap.last = cycle;
      ++gap.rows;
      return;
    }
  }
  report_.gaps.push_back({.law = law_, .run = run, .first = cycle, .last = cycle, .rows = 1, .reason = reason_});
  gap_ = report_.gaps.size();
}

}  // namespace robot_control
