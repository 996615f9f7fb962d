#pragma once
/// A LoopReplay replays a closed loop while it runs: robot_control._robot_control.LoopReplay, for campaigns.

#include <pybind11/pybind11.h>

#include <string>
#include <vector>

#include "log/messages/trace_message.h"
#include "log/replay/replay.h"
#include "simulation/closed_loop.h"

namespace robot_control {

class LoopReplay {
 public:
  /// Is constructed before the first step of `loop`.
  explicit LoopReplay(ClosedLoop& loop)
      : replay_(loop.robot(), loop.parameters().loop.period()), joints_(loop.robot().machine().joints.size()) {
    loop.record();
  }

  /// Stores the rows of the last step; is called after each step.
  void store(const ClosedLoop& loop);

  /// Runs the laws again over the rows that were stored since the last call.
  void check();

  /// Returns the differences that were found; is called after the last row.
  pybind11::dict report();

 private:
  Replay replay_;
  std::size_t joints_;
  TraceDecoder decoder_{trace_definition()};
  std::vector<std::string> messages_;  ///< messages of the stored rows, as in a log
};

void bind_loop_replay(pybind11::module_& module);

/// Returns a report as a dict: exact, laws {name: {compared, different, not_compared, missing}}, rows, different_rows,
/// damaged_snapshots, differences, gaps.
pybind11::dict described(const ReplayReport& report);

}  // namespace robot_control
