#pragma once
/// A Robot is one machine of one kind with its laws, composed. Loop, log, replay and simulation know a robot by this
/// interface alone. Each kind is composed in one file of this folder.

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "bus/latest_value.h"
#include "configuration/live_parameters.h"
#include "gate/brake_law.h"
#include "gate/gate_parameters.h"
#include "gate/machine_needs.h"
#include "machine/machine_model.h"
#include "robots/laws.h"
#include "safety/safety_parameters.h"
#include "signals/live_tuning.h"
#include "signals/roles.h"

namespace robot_control {

/// An accepted request to change limits and gains.
struct Retuned {
  std::uint64_t count = 0;  ///< of the sets accepted, column `tuning` of the log
  std::vector<LiveValue> values;
};

/// Returns for instance "set 2: max_linear_speed from 1 to 0.5, pid_kp from derived to 1.5".
std::string sentence(const Retuned& retuned);

/// Changes limits and gains of a controller while it runs: the services ~set_parameters and ~set_parameter_map, without
/// ROS. Any ordinary thread may call it.
class Retuner {
 public:
  virtual ~Retuner() = default;

  /// Returns a copy for the controller behind this inbox.
  virtual std::unique_ptr<Retuner> clone(LatestValue<LiveTuning>& inbox) const = 0;

  /// Names the parameters with which the monitor runs where it read others (an override of its own).
  virtual void expect_monitor(const Parameters& monitor) = 0;

  /// Throws ParameterError with every reason; then nothing changes.
  virtual Retuned set(const std::string& request) = 0;

  /// Returns the parameters in force, as the user would have to set them.
  virtual Parameters in_force() const = 0;

  /// Returns each value with its range; those that are derived as the numbers that hold.
  virtual std::vector<LiveParameter> live() const = 0;
};

/// Returns the cycles for which the gate lets a ramp last. They are ⌈ramp_time/period⌉, the monitor's own deadline,
/// plus loss_cycles, for as long a loss may last. `period` is in s.
std::uint64_t longest_ramp(const SafetyParameters& safety, double period);

class Robot {
 public:
  virtual ~Robot() = default;

  virtual const MachineModel& machine() const noexcept = 0;

  /// Returns the name of the kind, which selects the program of its controller (signals/robot_kinds.h).
  virtual std::string_view kind() const noexcept = 0;

  /// Throws ParameterError with every reason why these parameters do not fit this machine.
  virtual void require_drivable() const = 0;

  /// Returns the RequestPart bits that its controller executes.
  virtual std::uint64_t executable() const noexcept = 0;

  virtual std::unique_ptr<EstimatorLaw> make_estimator() const = 0;
  virtual std::unique_ptr<ControllerLaw> make_controller() const = 0;
  virtual std::unique_ptr<MonitorLaw> make_monitor() const = 0;

  /// Returns the modes and inputs without which the laws of this kind do not work on any machine.
  virtual MachineNeeds needs() const = 0;

  /// Returns what the rate of the loop and the drives of this machine cost, in sentences of the node that plays `role`.
  virtual std::vector<std::string> rate_notes(Role /*role*/) const { return {}; }

  /// Returns the brakes of the driven joints, which come first, for drives that are given a torque once in each period.
  /// Returns none if such drives do not stop a robot of this kind.
  virtual std::vector<Brake> brakes() const { return {}; }

  /// Returns the stop profiles of this kind, and how long a ramp may last.
  virtual GateParameters gate() const = 0;

  /// `inbox` is that of the controller's cycle. Returns null if nothing of this kind's controller changes while it
  /// runs.
  virtual std::unique_ptr<Retuner> make_retuner(LatestValue<LiveTuning>& /*inbox*/) const { return nullptr; }
};

}  // namespace robot_control
