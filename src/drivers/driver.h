#pragma once
/// The interface to the machine. A simulator, a CAN bus and an EtherCAT master stand behind the same four calls.
/// tests/drivers/driver_contract.h holds any driver to it.

#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "drivers/laser_scan.h"
#include "gate/machine_needs.h"
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

  /// Brakes until the next `start`: at once where the drives brake by themselves, else from the next `write` on.
  /// Without one, no torque of an earlier command remains.
  virtual void stop() noexcept = 0;

  /// The operator requests a reset: a machine with a fault clears it and starts again. Never blocks.
  virtual void reset() noexcept {}

  /// Returns the machine in one line as far as it is known now, with what it does when this program is silent. Returns
  /// "" if there is nothing to say. Any thread may call it.
  virtual std::string description() const { return {}; }

  /// Returns what is suspicious about the machine, known after `start`; "" if nothing is.
  virtual std::string warning() const { return {}; }

  /// Returns the fault of the last `read` in words; "" without one.
  virtual std::string_view fault_message() const noexcept { return {}; }

  /// Returns true if the drives carry out commands of this mode. The loop does not start with a robot kind or a stop
  /// action (StopKind) that needs another one.
  virtual bool accepts(JointMode mode) const noexcept { return mode == JointMode::kBrake; }

  /// Returns true if the frames of `read` hold this input. The loop does not start with a robot kind that needs
  /// another one.
  virtual bool measures(MachineInput input) const noexcept {
    return input == MachineInput::kJointMotion || input == MachineInput::kJointEffort;
  }
};

/// The driver of a simulated machine. It waits when its node is late: time slips, cycles stay consecutive. Hardware
/// does not: the cycle number jumps by the periods missed.
class Simulator : public Driver {
 public:
  /// Returns the true state at t_k.
  virtual void truth(TruthFrame& truth) noexcept = 0;

  /// From the next `read` on the machine has these faults.
  virtual void inject(const InjectedFaults& faults) noexcept = 0;

  /// Returns the number of cycles from one laser scan to the next; 0: the machine has no laser.
  virtual std::uint64_t scan_cycles() const noexcept { return 0; }

  /// Returns what the laser measures in this true state; one ordinary thread at a time calls it. The same state gives
  /// the same bits. Without a laser there are no ranges.
  virtual LaserScan scan(const TruthFrame& /*truth*/) { return {}; }

  /// Returns a machine in the same state, which then gives the same bits; null: this machine cannot be copied.
  virtual std::unique_ptr<Simulator> clone() const { return nullptr; }

  /// From now on a device of the machine has a fault. Returns the problem with the list of words; "" if there is none.
  virtual std::string inject_device(std::string_view /*component*/, std::string_view /*kind*/) {
    return "this machine has no simulated devices (robot.drives)";
  }
};

/// Returns the driver as a simulator; null for hardware.
inline Simulator* simulator_of(Driver& driver) noexcept {
  return dynamic_cast<Simulator*>(&driver);
}

}  // namespace robot_control
