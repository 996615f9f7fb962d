#pragma once
/// Joins the four nodes' rows by cycle, in order.
///
/// The rows of a node arrive in the order in which it wrote them: run after run, with rising cycles. Cycle k is emitted
/// as soon as every node has given its row k, or a row of a later cycle or run. A run is over when every node has left
/// it; the run with the earliest sensor stamp follows. A dead node would hold the join up for ever. Once another node
/// is `window` rows ahead, the cycle is emitted without it. Its rows of emitted cycles are late: they are dropped and
/// counted. A later row of a node may answer the same cycle again; it is emitted by itself (JoinedRow::repeats).

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <tuple>
#include <vector>

#include "log/rows/joined_row.h"

namespace robot_control {

inline constexpr std::size_t kJoinWindow = 4096;  ///< rows; 4 s at 1 kHz, twice the size of the rings

struct JoinCounts {
  std::uint64_t emitted = 0;              ///< rows
  std::array<std::uint64_t, 4> absent{};  ///< rows emitted without this node, by TraceRing; tokens do not count
  std::array<std::uint64_t, 4> late{};    ///< rows dropped because their cycle was emitted already
};

class Join {
 public:
  /// `period` is in s. `sink` receives each row; its pointers are valid during the call.
  Join(double period, std::function<void(const JoinedRow&)> sink, std::size_t window = kJoinWindow);

  void add(const DriverTrace& row);
  void add(const EstimatorTrace& row);
  void add(const ControllerTrace& row);
  void add(const MonitorTrace& row);

  /// Emits the cycles for which another node is more than `window` rows ahead.
  void emit_beyond(std::size_t window);

  /// Emits all rows that still wait, at the end of the log.
  void finish() { drain(true); }

  const JoinCounts& counts() const noexcept { return counts_; }

 private:
  using Queues = std::tuple<std::deque<DriverTrace>, std::deque<EstimatorTrace>, std::deque<ControllerTrace>,
                            std::deque<MonitorTrace>>;

  template <std::size_t Node, class Row>
  void add_to(const Row& row);
  std::array<const FrameHead*, 4> fronts() const;
  bool may_proceed(const std::array<const FrameHead*, 4>& fronts) const;
  void drain(bool force);
  void begin_run(std::uint64_t run);
  void emit(std::uint64_t cycle);
  template <std::size_t Node, class Row>
  bool repeats(const Row& row);
  void give_repeated();

  double period_;
  std::function<void(const JoinedRow&)> sink_;
  std::size_t window_;
  Queues queues_;
  std::optional<std::uint64_t> run_;  ///< the run being emitted
  std::int64_t run_index_ = -1;
  std::optional<std::uint64_t> last_cycle_;  ///< the last cycle of this run that was emitted
  std::vector<std::uint64_t> finished_runs_;
  struct Newest {
    std::uint64_t process = 0;
    std::uint64_t number = 0;
    std::uint64_t run = 0;
    std::uint64_t cycle = 0;
  };
  std::array<Newest, 4> newest_{};  ///< the newest row of each node
  Queues repeated_;                 ///< these rows wait until the cycle that they repeat is emitted
  JoinCounts counts_;
};

}  // namespace robot_control
