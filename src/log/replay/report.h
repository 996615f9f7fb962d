#pragma once
/// The result of a replay.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "signals/law_snapshot.h"

namespace robot_control {

/// "gate", or the law's node.
std::string_view name_of(LawName law) noexcept;

/// One number that is computed differently from the log.
struct ReplayDifference {
  std::optional<LawName> law;  ///< that computed it; empty: it is a field of the row
  std::int64_t run = 0;        ///< JoinedRow::run
  std::uint64_t cycle = 0;
  std::string field;  ///< "effort_command[1]"; "digest" if the log holds only the frame's checksum
  std::string logged;
  std::string replayed;
};

/// Cycles of one law for one reason.
struct ReplayGap {
  LawName law = LawName::kGate;
  std::int64_t run = 0;
  std::uint64_t first = 0;
  std::uint64_t last = 0;
  std::uint64_t rows = 0;
  std::string reason;
};

struct LawReport {
  std::uint64_t compared = 0;      ///< rows
  std::uint64_t different = 0;     ///< of these
  std::uint64_t not_compared = 0;  ///< rows
  std::uint64_t missing = 0;       ///< rows of a process between two that are there
  std::uint64_t restored = 0;      ///< snapshots that the law was set to
};

struct ReplayReport {
  static constexpr std::size_t kMaxDifferences = 1000;

  std::array<LawReport, kLaws> laws;
  std::uint64_t rows = 0;                     ///< whose messages were compared
  std::uint64_t different_rows = 0;           ///< of these
  std::vector<ReplayDifference> differences;  ///< of the first rows that differ, in their order
  std::vector<ReplayGap> gaps;
  std::uint64_t damaged_snapshots = 0;  ///< whose checksum is wrong: not used

  /// The first kMaxDifferences are kept.
  void add(ReplayDifference difference) {
    if (differences.size() < kMaxDifferences) differences.push_back(std::move(difference));
  }

  /// Everything that could be compared was computed again, bit for bit, and there was at least one row.
  bool exact() const noexcept;
};

/// "controller, run 0, cycle 1234: effort_command[1] is 0.5, logged as 0.25"; of a field of the row: "row, …"
std::string sentence(const ReplayDifference& difference);

/// "monitor, run 0, cycles 10 … 29 (20 rows): rows are missing"
std::string sentence(const ReplayGap& gap);

}  // namespace robot_control
