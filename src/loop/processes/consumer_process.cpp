#include "loop/processes/consumer_process.h"

#include "rt/clock.h"

namespace robot_control {

Now clock_of(const LoopParameters& loop) {
  return loop.clock == ClockMode::kLockstep ? nullptr : &monotonic_ns;
}

}  // namespace robot_control
