#pragma once
/// The closed loop in one process, in virtual time: the very same cycles as the four nodes run, on channels
/// in private memory. For tests, Python and campaigns.
///
/// One `step` is: driver tick k, estimator k, controller k, monitor k. Same parameters, seed and inputs give
/// the same bits, and the same bits as the four nodes in lockstep.

#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "parameters/parameters.h"
#include "robot/robot_model.h"
#include "signals/geometry.h"
#include "signals/law_snapshot.h"
#include "telemetry/joined_row.h"
#include "telemetry/row_log.h"

namespace robot_control {

class ClosedLoop {
 public:
  /// Reads the robot named by the parameters and sets a MuJoCo plant down in the scene. Throws RobotError,
  /// DriverError, ParameterError. Telemetry, clock and real-time parameters have no effect.
  explicit ClosedLoop(const Parameters& parameters);
  ~ClosedLoop();
  ClosedLoop(ClosedLoop&&) noexcept;
  ClosedLoop& operator=(ClosedLoop&&) noexcept;

  /// As if just received on cmd_vel: takes effect in the next step, in cycle 1 at the earliest (in cycle 0 the
  /// nodes enter the run), and times out like cmd_vel.
  void command(const Twist& twist) noexcept;

  /// As if e_stop_trigger, e_stop_reset had been called, as if a heartbeat had arrived.
  void e_stop() noexcept;
  void e_stop_reset() noexcept;
  void heartbeat() noexcept;

  /// One cycle. Time stands still between two steps: that is this loop's pause.
  void step() noexcept;

  /// As `~reset` of mujoco_plant: the robot returns to its initial pose, without injected faults, and a new run begins
  /// at cycle 0. Estimator, controller and counters restart, commands received before are dropped, latched stops
  /// stay. Apart from `run` and from such a stop its rows are those of a new ClosedLoop, bit for bit. Throws
  /// DriverError.
  void reset();

  /// As `~set_parameter_map` of diff_drive_controller: a YAML map of its limits and gains, from the next step on, and
  /// beyond `reset`. Throws ParameterError with every reason; then nothing has changed.
  void set_parameters(const std::string& request);

  /// The machine, as by `~inject_fault`, or a node (faults/node_faults.h) fails so from the next step on; words of
  /// names.h. Throws std::invalid_argument with the list where it does not know one.
  void inject_fault(const std::string& component, const std::string& kind);

  /// Cycle and time [s] of the sample that the next step takes.
  std::uint64_t cycle() const noexcept;
  double time() const noexcept;

  /// What the four nodes published in the last step.
  const JoinedRow& row() const noexcept;

  /// The states of the laws before the last step, where they were copied; null otherwise. In the order of LawName.
  std::array<const LawSnapshot*, kLaws> snapshots() const noexcept;

  /// From the next step on, every row and snapshot goes there, too; null: nowhere. The one before is returned, not
  /// closed.
  std::unique_ptr<RowLog> set_log(std::unique_ptr<RowLog> log);

  /// Why the log has ended; empty: it has not.
  const std::string& log_problem() const noexcept;

  const RobotModel& robot() const noexcept;
  const Parameters& parameters() const noexcept;

 private:
  void write_down() noexcept;

  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace robot_control
