#pragma once
/// A ClosedLoop runs the loop in one process and in virtual time, for tests, Python and campaigns. It runs the same
/// cycles as the four nodes, on channels in private memory.
///
/// One `step` is driver tick k, estimator k, controller k, monitor k. The same parameters, seed and inputs give the
/// same bits; these are also those of the four nodes in lockstep.

#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "configuration/parameters.h"
#include "drivers/laser_scan.h"
#include "log/rows/joined_row.h"
#include "log/rows/row_log.h"
#include "robots/robot.h"
#include "signals/geometry.h"
#include "signals/law_snapshot.h"

namespace robot_control {

class ClosedLoop {
 public:
  /// Reads the robot that the parameters name and places a MuJoCo plant in the scene. Throws RobotError, DriverError,
  /// ParameterError. Telemetry, clock and real-time parameters have no effect.
  explicit ClosedLoop(const Parameters& parameters);

  /// Does the same with a robot of any kind, which was composed with these parameters.
  ClosedLoop(const Parameters& parameters, std::shared_ptr<const Robot> robot);
  ~ClosedLoop();
  ClosedLoop(ClosedLoop&&) noexcept;
  ClosedLoop& operator=(ClosedLoop&&) noexcept;

  /// Acts like a message received now on cmd_vel: it takes effect in the next step and times out like cmd_vel. The
  /// earliest cycle is 1, because the nodes enter the run in cycle 0.
  void command(const Twist& twist) noexcept;
  /// The same with every part of a request.
  void request(const Request& request) noexcept;

  /// Sets Request::mode of later commands other than zero, as set_gait of a robot on legs does. It ends with the
  /// permission to move.
  void choose_mode(const Mode& mode) noexcept;

  /// These act like calls of e_stop_trigger and e_stop_reset, and like a message on heartbeat.
  void e_stop() noexcept;
  void e_stop_reset() noexcept;
  void heartbeat() noexcept;

  /// Acts like a message on clearance, m.
  void clearance(double metres) noexcept;

  /// Runs one cycle. Time does not pass between two steps.
  void step() noexcept;

  /// Acts like `~reset` of the simulator: the robot returns to its initial pose without injected faults, and a new run
  /// begins at cycle 0. Estimator, controller and counters restart, earlier commands are dropped, latched stops stay.
  /// Except for `run` and such a stop, its rows equal those of a new ClosedLoop bit for bit. Throws DriverError.
  void reset();

  /// Acts like `~set_parameter_map` of the controller: a YAML map of its limits and gains is in force from the
  /// next step on, also after `reset`. Throws ParameterError with every problem and then changes nothing.
  void set_parameters(const std::string& request);

  /// Injects a fault from the next step on, into the machine as by `~inject_fault`, or into a node
  /// (simulation/faults/node_faults.h). Simulated drives have faults of their own (drivers/drive/device_front.h).
  /// Throws std::invalid_argument with the list of words if one is unknown.
  void inject_fault(const std::string& component, const std::string& kind);

  /// Return cycle and time [s] of the sample in the next step.
  std::uint64_t cycle() const noexcept;
  double time() const noexcept;

  /// Returns the rows that the four nodes published in the last step.
  const JoinedRow& row() const noexcept;

  /// Returns what the laser measures in the true state of the last step, whichever cycle it is (laser_parameters.h).
  /// Without a laser there are no ranges.
  LaserScan scan() const;

  /// Returns the states of the laws before the last step in the order of LawName; null for those that were not copied.
  std::array<const LawSnapshot*, kLaws> snapshots() const noexcept;

  /// Writes every row and snapshot to `log` from the next step on; to no log if it is null. Returns the previous log,
  /// which is not closed.
  std::unique_ptr<RowLog> set_log(std::unique_ptr<RowLog> log);

  /// Returns the reason why the log has ended; "" if it has not.
  const std::string& log_problem() const noexcept;

  const Robot& robot() const noexcept;
  const Parameters& parameters() const noexcept;

 private:
  void write_down() noexcept;

  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace robot_control
