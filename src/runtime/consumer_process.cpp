#include "runtime/consumer_process.h"

#include "rt/clock.h"

namespace robot_control {

CommandScript load_script(const LoopParameters& loop) {
  return loop.command_script.empty() ? CommandScript() : CommandScript(loop.command_script);
}

Now clock_of(const LoopParameters& loop) {
  return loop.clock == ClockMode::kLockstep ? nullptr : &monotonic_ns;
}

}  // namespace robot_control
