#pragma once
/// The services of a simulator, without ROS: an operator controls a simulated machine while it runs.
///
/// Every call may come from any ordinary thread. It returns once it is done, or says why it is not; `step` and
/// `reset` refuse while another one of them is under way.

#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "drivers/driver.h"
#include "loop/cycles/driver_cycle.h"
#include "loop/processes/loop_hold.h"
#include "machine/machine_model.h"

namespace robot_control {

struct ServiceAnswer {
  bool success = false;
  std::string message;
};

class SimulationServices {
 public:
  /// `missing` is called by any thread and returns the nodes that the loop waits for.
  SimulationServices(const MachineModel& machine, LoopHold& hold, Driver& driver, DriverCycle& cycle,
                     std::function<std::vector<std::string>()> missing);

  /// Paused, the machine does not move and stamps do not advance; the others see the last frame again, as paused.
  /// Time that passed meanwhile is neither caught up nor slip.
  ServiceAnswer set_pause(bool pause);

  /// While paused: runs exactly so many cycles, then stands again.
  ServiceAnswer step(std::uint64_t cycles);

  /// The machine returns to its initial pose, without faults. A new run begins at cycle 0, one period after the last
  /// stamp: estimator, controller and counters restart, a latched stop stays. A paused machine stays paused. If the
  /// machine does not start, the reset fails, and the old run goes on with the driver's fault.
  ServiceAnswer reset();

  /// From the next cycle on; words of machine/fault_names.h, "ok" ends a fault. Unknown ones are answered with the
  /// list. A fault of a node is refused: the processes contain no simulated faults, and ClosedLoop injects them.
  ServiceAnswer inject_fault(const std::string& component, const std::string& kind);

 private:
  struct Steps {
    std::uint64_t number = 0;  ///< number of the request
    std::uint64_t first = 0;
    std::uint64_t target = 0;  ///< the cycle behind the last one
  };

  std::uint64_t send_request();
  std::uint64_t request_pause(bool pause);
  ServiceAnswer await_steps(const Steps& steps);
  std::string waiting_for() const;

  const MachineModel& machine_;
  LoopHold& hold_;
  Driver& driver_;
  DriverCycle& cycle_;
  std::function<std::vector<std::string>()> missing_;
  std::mutex request_mutex_;  ///< guards `request_`
  std::mutex exclusive_;      ///< held by step and reset
  LoopHold::Request request_;
};

}  // namespace robot_control
