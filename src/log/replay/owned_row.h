#pragma once
/// A row of the log that owns the rows of its nodes.

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "log/rows/trace_row.h"

namespace robot_control {

class OwnedRow {
 public:
  explicit OwnedRow(const JoinedRow& row) : run_(row.run), cycle_(row.cycle), repeats_(row.repeats) {
    keep(row.driver, driver_, has_[0]);
    keep(row.laws.estimator, estimator_, has_[1]);
    keep(row.laws.controller, controller_, has_[2]);
    keep(row.laws.monitor, monitor_, has_[3]);
  }

  /// A row that was read from a log, with the bytes of its message and the time of that message.
  OwnedRow(const TraceRow& row, std::string_view message, std::int64_t time_ns) : OwnedRow(row.joined(0)) {
    message_ = message;
    time_ns_ = time_ns;
    run_id_ = row.run_id;
    lost_ = row.lost;
  }

  /// The same row; its pointers are valid as long as this object lives.
  JoinedRow joined() const noexcept {
    JoinedRow row{.run = run_, .cycle = cycle_, .time = 0, .driver = driver()};
    row.repeats = repeats_;
    row.set({estimator(), controller(), monitor()});
    return row;
  }

  std::int64_t run() const noexcept { return run_; }
  std::uint64_t cycle() const noexcept { return cycle_; }
  bool repeats() const noexcept { return repeats_; }
  const std::string& message() const noexcept { return message_; }  ///< empty: the row is of no log
  std::int64_t time_ns() const noexcept { return time_ns_; }
  std::uint64_t run_id() const noexcept { return run_id_; }
  std::uint64_t lost() const noexcept { return lost_; }

  /// Its place among the rows, as computed.
  void set_place(std::int64_t run, bool repeats) noexcept {
    run_ = run;
    repeats_ = repeats;
  }

  /// Null: that node has no row in this cycle.
  const DriverTrace* driver() const noexcept { return has_[0] ? &driver_ : nullptr; }
  const EstimatorTrace* estimator() const noexcept { return has_[1] ? &estimator_ : nullptr; }
  const ControllerTrace* controller() const noexcept { return has_[2] ? &controller_ : nullptr; }
  const MonitorTrace* monitor() const noexcept { return has_[3] ? &monitor_ : nullptr; }
  DriverTrace* driver() noexcept { return has_[0] ? &driver_ : nullptr; }
  EstimatorTrace* estimator() noexcept { return has_[1] ? &estimator_ : nullptr; }
  ControllerTrace* controller() noexcept { return has_[2] ? &controller_ : nullptr; }
  MonitorTrace* monitor() noexcept { return has_[3] ? &monitor_ : nullptr; }

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
  std::string message_;
  std::int64_t time_ns_ = 0;
  std::uint64_t run_id_ = 0;
  std::uint64_t lost_ = 0;
};

}  // namespace robot_control
