#pragma once
/// Joins the four nodes' rows by cycle, in order.
///
/// Each node's rows arrive in the order in which it wrote them: run after run, cycles rising. Cycle k is emitted
/// as soon as every node has given its row k or has moved past k, to a later cycle or a later run. A run is over
/// when every node has left it; of the runs that follow, the one whose sensor stamp is earliest comes next. A
/// dead or missing node would hold that up for ever: once another one is `window` rows ahead, its cells stay
/// empty. What it delivers for cycles already emitted is late: dropped and counted. A later row
/// of a node may answer the same cycle again: it is emitted by itself (JoinedRow::repeats).

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <tuple>
#include <vector>

#include "telemetry/joined_row.h"

namespace robot_control {

inline constexpr std::size_t kJoinWindow = 4096;  ///< rows: 4 s at 1 kHz, twice the rings

struct JoinCounts {
  std::uint64_t emitted = 0;              ///< rows
  std::array<std::uint64_t, 4> absent{};  ///< emitted without this node (order of TraceRing); tokens excepted
  std::array<std::uint64_t, 4> late{};    ///< rows dropped because their cycle was emitted already
};

class Join {
 public:
  /// `period`: s. `sink` gets each row; its pointers are valid during the call.
  Join(double period, std::function<void(const JoinedRow&)> sink, std::size_t window = kJoinWindow);

  void add(const DriverTrace& row);
  void add(const EstimatorTrace& row);
  void add(const ControllerTrace& row);
  void add(const MonitorTrace& row);

  /// The end of the log: emits everything that still waits.
  void finish();

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
  std::optional<std::uint64_t> last_cycle_;  ///< emitted of it
  std::vector<std::uint64_t> finished_runs_;
  struct Newest {
    std::uint64_t process = 0;
    std::uint64_t number = 0;
    std::uint64_t run = 0;
    std::uint64_t cycle = 0;
  };
  std::array<Newest, 4> newest_{};  ///< of each node
  Queues repeated_;                 ///< wait until the cycle that they repeat is emitted
  JoinCounts counts_;
};

}  // namespace robot_control
