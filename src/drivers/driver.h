#pragma once
/// The interface to the machine. A simulator, a CAN bus and an EtherCAT master stand behind the same four calls.
/// tests/drivers/driver_contract.h holds any driver to it.

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "gate/stop_action.h"
#include "signals/injected_fault.h"
#include "signals/joint.h"
#include "signals/sensor_frame.h"
#include "signals/truth_frame.h"

namespace robot_control {

/// Start-up failed: what, where, remedy.
class DriverError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class Driver {
 public:
  virtual ~Driver() = default;

  /// Brings the machine to a state in which `read` and `write` may be called; brakes hold. Throws DriverError.
  virtual void start() = 0;

  /// Sensors of x(t_k): everything of the frame but head, driver_instance, gate and counters. Never blocks.
  virtual void read(SensorFrame& sensors) noexcept = 0;

  /// Applies the commands, one per joint in frame order, over [t_k, t_k+1). An unknown mode, or a number that is not
  /// finite, brakes its joint. Never blocks. A simulated machine advances.
  virtual void write(std::span<const JointCommand> commands) noexcept = 0;

  /// Brakes, at once and until the next `start`.
  virtual void stop() noexcept = 0;

  /// Returns what is suspicious about the machine, known after `start`; "" if nothing is.
  virtual std::string warning() const { return {}; }

  /// Returns the fault of the last `read` in words; "" without one.
  virtual std::string_view fault_message() const noexcept { return {}; }

  /// Returns true if the drives carry out the order of this stop action (order_of). The loop does not start with a
  /// joint that is to be stopped by another one.
  virtual bool implements(StopKind kind) const noexcept { return kind == StopKind::kBrake; }

  /// A simulated machine waits when its node is late: time slips, cycles stay consecutive. Hardware does not:
  /// the cycle number jumps by the periods missed.
  virtual bool simulated() const noexcept { return false; }

  /// The true state at t_k, of a simulator. False: this driver has none.
  virtual bool truth(TruthFrame& /*truth*/) noexcept { return false; }

  /// From the next `read` on the machine has these faults. False: it is no simulator.
  virtual bool inject(const InjectedFaults& /*faults*/) noexcept { return false; }
};

}  // namespace robot_control
