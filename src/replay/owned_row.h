#pragma once
/// A row of the log with what its pointers point to.

#include "telemetry/joined_row.h"

namespace robot_control {

class OwnedRow {
 public:
  explicit OwnedRow(const JoinedRow& row) : run_(row.run), cycle_(row.cycle), repeats_(row.repeats) {
    keep(row.driver, driver_, has_[0]);
    keep(row.laws.estimator, estimator_, has_[1]);
    keep(row.laws.controller, controller_, has_[2]);
    keep(row.laws.monitor, monitor_, has_[3]);
  }

  /// The same row; it holds as long as this object.
  JoinedRow joined() const noexcept {
    JoinedRow row{.run = run_, .cycle = cycle_, .time = 0, .driver = driver()};
    row.repeats = repeats_;
    row.set({estimator(), controller(), monitor()});
    return row;
  }

  std::int64_t run() const noexcept { return run_; }
  std::uint64_t cycle() const noexcept { return cycle_; }

  /// Null: that node has no row in this cycle.
  const DriverTrace* driver() const noexcept { return has_[0] ? &driver_ : nullptr; }
  const EstimatorTrace* estimator() const noexcept { return has_[1] ? &estimator_ : nullptr; }
  const ControllerTrace* controller() const noexcept { return has_[2] ? &controller_ : nullptr; }
  const MonitorTrace* monitor() const noexcept { return has_[3] ? &monitor_ : nullptr; }

 private:
  template <class Row>
  static void keep(const Row* row, Row& to, bool& has) noexcept {
    has = row != nullptr;
    if (has) to = *row;
  }

  std::int64_t run_;
  std::uint64_t cycle_;
  bool repeats_;
  std::array<bool, 4> has_{};
  DriverTrace driver_;
  EstimatorTrace estimator_;
  ControllerTrace controller_;
  MonitorTrace monitor_;
};

}  // namespace robot_control
