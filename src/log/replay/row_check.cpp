#include "log/replay/row_check.h"

#include <algorithm>
#include <vector>

#include "log/replay/field_differences.h"

namespace robot_control {

void RowCheck::check(TraceRow& row, std::string_view message, std::int64_t time_ns) {
  place(row);
  const JoinedRow computed = row.joined(0);
  const std::vector<FieldDifference> fields =
      differences(message, {.row = computed, .lost = row.lost, .joints = joints_, .time_ns = time_ns});
  ++report_.rows;
  if (!fields.empty()) ++report_.different_rows;
  for (const FieldDifference& field : fields) {
    report_.add({{}, row.run, row.cycle, field.field, field.logged, field.replayed});
  }
}

/// The rows of a run are in the order of their cycles. A row that repeats a cycle follows the row of that cycle.
void RowCheck::place(TraceRow& row) noexcept {
  const bool goes_on = run_ >= 0 && row.run_id == run_id_;
  const std::uint64_t cycle = goes_on && row.repeats ? cycle_ : row.cycle;
  row.run = goes_on ? run_ : std::max(row.run, run_ + 1);
  row.repeats = goes_on && row.cycle <= cycle_;
  run_ = row.run;
  run_id_ = row.run_id;
  cycle_ = cycle;
}

}  // namespace robot_control
