#include "loop/machine_identity.h"

#include <cmath>

#include "signals/checksum.h"

namespace robot_control {

MachineModel identified(MachineModel machine, const LoopParameters& loop) {
  const bool lockstep = loop.clock == ClockMode::kLockstep;
  Checksum sum;
  sum.mix(machine.hash);
  sum.mix(static_cast<std::uint64_t>(loop.period_ns()));
  sum.mix(lockstep ? 1 : 2);
  machine.hash = sum.sum();
  machine.source += " at " + std::to_string(std::lround(loop.rate)) + " Hz, clock " + (lockstep ? "lockstep" : "wall");
  return machine;
}

}  // namespace robot_control
