#pragma once
/// Decides whether the state of a replayed law is that before the next row, and lists the rows that were not compared.

#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <tuple>

#include "log/replay/report.h"
#include "signals/law_calls.h"
#include "signals/law_snapshot.h"

namespace robot_control {

/// A log cannot be replayed; the message names the reason and the remedy.
struct ReplayError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The snapshots of all laws.
class SnapshotStore {
 public:
  /// Throws ReplayError if the snapshot is of another build. False: its checksum is wrong, and it is not used.
  bool add(const LawSnapshot& snapshot);

  /// Null: no snapshot was taken at this row.
  const LawSnapshot* find(LawName law, const LawRow& row) const;

 private:
  using Key = std::tuple<LawName, std::uint64_t, std::uint64_t>;  ///< law, process, number
  std::map<Key, LawSnapshot> snapshots_;
};

/// The origin of the state before a row.
enum class StateBefore { kUnknown, kContinued, kRestored };

/// The continuity of one law.
class Continuity {
 public:
  Continuity(LawName law, ReplayReport& report) noexcept : law_(law), report_(report) {}

  /// The origin of the state before this row. If rows are missing, `restore(snapshot)` sets the law to a snapshot.
  template <class Restore>
  StateBefore before(const LawRow& row, const SnapshotStore& snapshots, Restore restore) {
    const bool follows = known_ && row.process == process_ && row.number == next_;
    if (row.process == process_ && row.number > next_) report().missing += row.number - next_;
    if (known_ && !follows) lose(row.process == process_ ? "rows are missing" : "another process, without a snapshot");
    process_ = row.process;
    next_ = row.number + 1;
    if (follows) return StateBefore::kContinued;
    const LawSnapshot* snapshot = snapshots.find(law_, row);
    if (snapshot == nullptr || !restore(*snapshot)) return StateBefore::kUnknown;
    ++report().restored;
    known_ = true;
    return StateBefore::kRestored;
  }

  LawName law() const noexcept { return law_; }
  bool known() const noexcept { return known_; }

  /// The state is unknown until the next snapshot.
  void lose(const std::string& reason) {
    known_ = false;
    reason_ = reason;
  }

  /// This row was not compared.
  void pass_over(std::int64_t run, std::uint64_t cycle);

  /// This row was compared.
  void compare() noexcept {
    ++report().compared;
    gap_ = 0;
  }

  LawReport& report() noexcept { return report_.laws[static_cast<std::size_t>(law_)]; }

 private:
  LawName law_;
  ReplayReport& report_;
  bool known_ = false;
  std::uint64_t process_ = 0;
  std::uint64_t next_ = 0;  ///< number of the row that follows
  std::string reason_ = "no snapshot yet";
  std::size_t gap_ = 0;  ///< index + 1 of the gap that continues; 0: none
};

}  // namespace robot_control
