#pragma once
/// safety_monitor's law: facts of one cycle → permit of that cycle.
///
///   facts ─► Conditions (StopCause bits) ─► Supervisor (latch, table) ─► Permit
///
/// INIT until sensors, state and command of this run were each seen; then READY or DRIVE permit motion until a
/// cause latches a stop (stop_category.h). The permit of cycle k is alive until k + kPermitLife: a monitor that
/// makes no progress permits nothing.

#include <cstdint>
#include <optional>

#include "robot/robot_model.h"
#include "safety/conditions.h"
#include "safety/monitor_input.h"
#include "safety/safety_parameters.h"
#include "safety/standstill.h"
#include "safety/supervisor.h"
#include "signals/permit.h"
#include "signals/sensor_frame.h"
#include "signals/velocity_command.h"

namespace robot_control {

class SafetyMonitor {
 public:
  /// `period` s. Throws std::invalid_argument: a period, speed or time out of range, loss_cycles 0.
  SafetyMonitor(const SafetyParameters& parameters, const RobotModel& robot, double period);

  /// A new run: sightings and counts begin anew; latched causes stay. `operator_input` is the inbox now:
  /// resets and heartbeats in it are dropped, emergency stops that were not yet acted on are not.
  void reset(const OperatorInput& operator_input) noexcept;

  /// After a restart of the monitor: `last` is what the channel still holds. Decided at the first step: if the
  /// driver that `last` was issued for still runs, the monitor begins STOPPED with kCauseMonitorRestarted and
  /// what was latched then; if both started anew, in INIT. Without a readable `last` the driver is the witness:
  /// a gate that has used a permit of this run was served by an earlier monitor.
  void resume(const Permit& last) noexcept;

  /// The driver has been silent for 20 periods (wall clock only): latches kCauseDriverLost from the next step
  /// on. No effect before the first step (a driver that was never there is missing, not lost) or while the
  /// driver's last word was "paused".
  void driver_lost() noexcept;

  /// Three sensor frames in a row were corrupt: latches kCauseCorruptFrame from the next step on.
  void sensors_corrupt() noexcept { pending_ |= kCauseCorruptFrame; }

  /// No frame comes, so nothing can be judged: a reset asked for meanwhile is answered with `why` and does not
  /// release anything later.
  void refuse_reset(const OperatorInput& operator_input, ResetRefusal why = kRefusalSilent) noexcept;

  /// Fills everything but `out.head`. A second step in the same cycle counts nothing twice.
  void step(const MonitorInput& input, Permit& out) noexcept;

 private:
  void decide_restart(const SensorFrame& sensors) noexcept;

  Conditions conditions_;
  JointStandstill standstill_;
  Supervisor supervisor_;
  std::optional<Permit> last_;          ///< of an earlier monitor, until the first step
  std::optional<std::uint64_t> cycle_;  ///< of the last step in this run
  std::uint64_t active_ = 0;            ///< causes true in that step
  std::uint64_t pending_ = 0;           ///< causes from outside a step
  bool driver_known_ = false;
  bool driver_paused_ = false;
  std::uint64_t resets_handled_ = 0;
  std::uint64_t reset_refusal_ = 0;
};

}  // namespace robot_control
