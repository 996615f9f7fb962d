#pragma once
/// A ClosedLoop runs the loop in one process and in virtual time, for tests, Python and campaigns. It runs the same
/// cycles as the four nodes, on channels in private memory.
///
/// One `step` is driver tick k, estimator k, controller k, monitor k. The same parameters, seed and inputs give the
/// same bits; these are also those of the four nodes in lockstep.

#include <array>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>

#include "configuration/parameters.h"
#include "drivers/driver.h"
#include "log/rows/joined_row.h"
#include "log/rows/row_log.h"
#include "loop/cycles/controller_cycle.h"
#include "loop/cycles/driver_cycle.h"
#include "loop/cycles/estimator_cycle.h"
#include "loop/cycles/monitor_cycle.h"
#include "robots/robot.h"
#include "signals/geometry.h"
#include "signals/law_snapshot.h"
#include "simulation/faults/node_faults.h"

namespace robot_control {

class ClosedLoop {
 public:
  /// Reads the robot that the parameters name and places a MuJoCo plant in the scene. Throws RobotError, DriverError,
  /// ParameterError. Telemetry, clock and real-time parameters have no effect.
  explicit ClosedLoop(const Parameters& parameters) : ClosedLoop(parameters, nullptr) {}

  /// Does the same with a robot of any kind, which was composed with these parameters. `machine` is another one than
  /// they name, for example one whose line leads through other programs; null: theirs.
  ClosedLoop(const Parameters& parameters, std::shared_ptr<const Robot> robot,
             std::unique_ptr<Driver> machine = nullptr);

  /// A copy continues bit for bit as the original, but writes no log and has no row before its first step. Throws
  /// DriverError for a machine behind simulated drives.
  ClosedLoop(const ClosedLoop& other);

  /// Acts like a message received now on cmd_vel: it takes effect in the next step and times out like cmd_vel. The
  /// earliest cycle is 1, because the nodes enter the run in cycle 0.
  void command(const Twist& twist) noexcept { request({.twist = twist, .mode = zero(twist) ? Mode{} : mode_}); }
  /// The same with every part of a request.
  void request(const Request& content) noexcept {
    fresh_ = handed_over_ = false;
    request_ = {.content = content, .count = request_.count + 1};
  }

  /// Sets Request::mode of later commands other than zero, as set_gait of a robot on legs does. It ends with the
  /// permission to move.
  void choose_mode(const Mode& mode) noexcept {
    fresh_ = false;
    mode_ = mode;
  }

  /// These act like calls of e_stop_trigger and e_stop_reset, and like a message on heartbeat.
  void e_stop() noexcept { ++operated().e_stop_services; }
  void e_stop_reset() noexcept { ++operated().resets; }
  void heartbeat() noexcept { ++operated().heartbeats; }

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

  /// Returns true until the first call of a function that changes anything.
  bool fresh() const noexcept { return fresh_; }

  /// Return cycle and time [s] of the sample in the next step.
  std::uint64_t cycle() const noexcept { return driver_.next_cycle(); }
  double time() const noexcept { return row_time(cycle(), parameters_.loop.period()); }

  /// Returns the rows that the four nodes published in the last step.
  const JoinedRow& row() const noexcept { return row_; }

  /// Returns what the laser measures in the true state of the last step, whichever cycle it is (LaserParameters).
  /// Without a laser there are no ranges.
  LaserScan scan() const;

  /// From the next step on frames have checksums, and the states of the laws are copied. A log and a replay need both,
  /// which cost a tenth of a cycle.
  void record() noexcept;

  /// Returns the states of the laws before the last step in the order of LawName; null for those that were not copied.
  std::array<const LawSnapshot*, kLaws> snapshots() const noexcept;

  /// Records, and writes every row and snapshot to `log` from the next step on; to no log if it is null. Returns the
  /// previous log, which is not closed.
  std::unique_ptr<RowLog> set_log(std::unique_ptr<RowLog> log);

  /// Returns the reason why the log has ended; "" if it has not.
  const std::string& log_problem() const noexcept { return log_problem_; }

  /// Returns what is suspicious about the machine; "" if nothing is.
  std::string warning() const { return machine_->warning(); }

  const Robot& robot() const noexcept { return *robot_; }
  const std::shared_ptr<const Robot>& shared_robot() const noexcept { return robot_; }
  const Parameters& parameters() const noexcept { return parameters_; }

 private:
  /// A channel of this thread with its writer and its reader.
  template <class Frame>
  struct Channel {
    /// `kept` frames are as many as a reader looks back.
    explicit Channel(std::size_t kept) { frames->kept = kept; }
    Channel(const Channel& other) : frames(std::make_unique<OwnFrames<Frame>>(*other.frames)) {
      // One thread uses these atomics, and a channel has the same bytes in every process.
      std::memcpy(static_cast<void*>(memory.get()), other.memory.get(), sizeof *memory);
    }

    std::unique_ptr<LatestFrames<Frame>> memory = std::make_unique<LatestFrames<Frame>>();
    std::unique_ptr<OwnFrames<Frame>> frames = std::make_unique<OwnFrames<Frame>>();
    FrameWriter<Frame> writer{memory.get(), frames.get()};
    FrameReader<Frame> reader{memory.get(), frames.get()};
  };

  OperatorInput& operated() noexcept {
    fresh_ = handed_over_ = false;
    return operator_input_;
  }
  void hand_over() noexcept;
  void write_down() noexcept;

  Parameters parameters_;
  std::shared_ptr<const Robot> robot_;
  std::unique_ptr<Driver> machine_;
  Channel<SensorFrame> sensors_{1};  ///< of this cycle
  Channel<StateFrame> state_{2};     ///< of this cycle, and to the monitor of the one before
  Channel<CommandFrame> command_{kCommandLife};
  Channel<Permit> permit_{kFrameSlots};
  DriverCycle driver_;
  EstimatorCycle estimator_;
  ControllerCycle controller_;
  MonitorCycle monitor_;
  EstimatorFaults estimator_faults_{FaultComponent::kEstimator, state_.writer};
  ControllerFaults controller_faults_{FaultComponent::kController, command_.writer};
  MonitorFaults monitor_faults_{FaultComponent::kMonitor, permit_.writer};
  std::unique_ptr<Retuner> retuner_;
  VelocityCommand request_;
  Mode mode_;  ///< of later commands
  OperatorInput operator_input_;
  InjectedFaults faults_{};
  bool fresh_ = true;
  bool handed_over_ = false;  ///< the nodes have the newest request and operator's input
  JoinedRow row_;
  std::unique_ptr<RowLog> log_;
  std::string log_problem_;
};

}  // namespace robot_control
