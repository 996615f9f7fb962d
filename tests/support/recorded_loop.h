#pragma once
/// A loop that records from its first cycle on.

#include "simulation/closed_loop.h"

namespace robot_control {

struct RecordedLoop : ClosedLoop {
  template <class... Arguments>
  explicit RecordedLoop(const Arguments&... arguments) : ClosedLoop(arguments...) {
    record();
  }
};

}  // namespace robot_control
