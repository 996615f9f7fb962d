#include "simulation/closed_loop.h"

#include <stdexcept>
#include <string>
#include <utility>

#include "log/log_error.h"
#include "loop/cycles/controller_cycle.h"
#include "loop/cycles/driver_cycle.h"
#include "loop/cycles/estimator_cycle.h"
#include "loop/cycles/monitor_cycle.h"
#include "loop/gate_setup.h"
#include "machine/fault_names.h"
#include "robots/robot_kind.h"
#include "signals/names.h"
#include "simulation/faults/node_faults.h"
#include "simulation/machines/simulated_machine.h"

namespace robot_control {
namespace {

constexpr std::uint64_t kDriverInstance =
    1;  // any number except 0; the same holds for a run: no other process uses these channels

/// Reads the command script. ClosedLoop is the only sender of commands, so each run begins with a zero request.
CommandScript script_of(const Parameters& parameters, const Robot& robot) {
  CommandScript script = load_script(parameters.loop.command_script, robot.executable());
  script.begin_with_zero();
  return script;
}

const Robot& drivable(const Robot& robot) {
  robot.require_drivable();
  return robot;
}

}  // namespace

struct ClosedLoop::Parts {
  /// A channel of this thread with its writer and its reader.
  template <class Frame>
  struct Channel {
    std::unique_ptr<LatestFrames<Frame>> memory = std::make_unique<LatestFrames<Frame>>();
    std::unique_ptr<OwnFrames<Frame>> frames = std::make_unique<OwnFrames<Frame>>();
    FrameWriter<Frame> writer{memory.get(), frames.get()};
    FrameReader<Frame> reader{memory.get(), frames.get()};
  };

  Parts(const Parameters& given, std::shared_ptr<const Robot> composed)
      : parameters(given),
        owner(std::move(composed)),
        robot(drivable(*owner)),
        machine(make_simulated_machine(given, robot.machine(), robot.brakes())),
        driver(*machine, robot.machine(), {sensors.writer, FrameWriter<TruthFrame>(), &command.reader, &permit.reader},
               given.loop.period_ns(), nullptr, robot.gate()),
        estimator(robot.make_estimator(), robot.machine().hash, sensors.reader, state.writer, nullptr),
        controller(robot.make_controller(), robot.machine().hash,
                   {&sensors.reader, &state.reader, &permit.reader, command.writer}, script_of(given, robot), nullptr),
        monitor(robot.make_monitor(), robot.machine().hash, 0,
                {&sensors.reader, &state.reader, &command.reader, permit.writer},
                load_script(given.loop.command_script), nullptr),
        retuner(robot.make_retuner(controller.tunings())) {
    require_needs(*machine, robot.needs());
    machine->start();
    driver.set_driver_instance(kDriverInstance);
    driver.begin_run(1);
  }

  /// Returns "" if done, else what is wrong with device or kind.
  std::string inject_device(const std::string& component, const std::string& kind) {
    Simulator* const simulator = simulator_of(*machine);
    return simulator == nullptr ? "no device is simulated" : simulator->inject_device(component, kind);
  }

  void hand_over() noexcept {
    controller.inbox().store(request);
    monitor.inbox().store(operator_input);
  }

  Parameters parameters;
  std::shared_ptr<const Robot> owner;
  const Robot& robot;
  std::unique_ptr<Driver> machine;
  Channel<SensorFrame> sensors;
  Channel<StateFrame> state;
  Channel<CommandFrame> command;
  Channel<Permit> permit;
  DriverCycle driver;
  EstimatorCycle estimator;
  ControllerCycle controller;
  MonitorCycle monitor;
  EstimatorFaults estimator_faults{FaultComponent::kEstimator, state.writer};
  ControllerFaults controller_faults{FaultComponent::kController, command.writer};
  MonitorFaults monitor_faults{FaultComponent::kMonitor, permit.writer};
  std::unique_ptr<Retuner> retuner;
  VelocityCommand request;
  Mode mode;  ///< of later commands
  OperatorInput operator_input;
  InjectedFaults faults{};
  JoinedRow row;
  std::unique_ptr<RowLog> log;
  std::string log_problem;
};

ClosedLoop::ClosedLoop(const Parameters& given) {
  const Parameters parameters = given.drives.empty() ? given : limited_by_drives(given, load_description(given.urdf));
  parts_ = std::make_unique<Parts>(parameters, make_robot(parameters));
}
ClosedLoop::ClosedLoop(const Parameters& parameters, std::shared_ptr<const Robot> robot)
    : parts_(std::make_unique<Parts>(parameters, std::move(robot))) {}
ClosedLoop::~ClosedLoop() = default;
ClosedLoop::ClosedLoop(ClosedLoop&&) noexcept = default;
ClosedLoop& ClosedLoop::operator=(ClosedLoop&&) noexcept = default;

void ClosedLoop::command(const Twist& twist) noexcept {
  request({.twist = twist, .mode = zero(twist) ? Mode{} : parts_->mode});
}
void ClosedLoop::choose_mode(const Mode& mode) noexcept {
  parts_->mode = mode;
}
void ClosedLoop::request(const Request& content) noexcept {
  parts_->request = {.content = content, .count = parts_->request.count + 1};
}

void ClosedLoop::e_stop() noexcept {
  ++parts_->operator_input.e_stop_services;
}
void ClosedLoop::e_stop_reset() noexcept {
  ++parts_->operator_input.resets;
}
void ClosedLoop::heartbeat() noexcept {
  ++parts_->operator_input.heartbeats;
}

void ClosedLoop::clearance(double metres) noexcept {
  ++parts_->operator_input.clearances;
  parts_->operator_input.clearance = metres;
}

void ClosedLoop::step() noexcept {
  Parts& parts = *parts_;
  if (cycle() > 0) parts.hand_over();  // every node drops inputs that arrive before a run begins
  parts.driver.step();
  const SensorFrame& sensors = parts.driver.trace().sensors;
  JoinedRow::Laws laws;
  if (parts.estimator.step()) laws.estimator = parts.estimator_faults.replace(sensors, parts.estimator.trace());
  if (parts.controller.step()) laws.controller = parts.controller_faults.replace(sensors, parts.controller.trace());
  const bool granted = parts.monitor.permit().action == PermitAction::kDrive;
  if (parts.monitor.step()) laws.monitor = parts.monitor_faults.replace(sensors, parts.monitor.trace());
  if (granted && parts.monitor.permit().action != PermitAction::kDrive) parts.mode = {};
  parts.row = {.run = static_cast<std::int64_t>(parts.driver.run()) - 1,
               .cycle = sensors.head.cycle,
               .time = row_time(sensors.head.cycle, parts.parameters.loop.period()),
               .driver = &parts.driver.trace()};
  parts.row.set(laws);
  write_down();
}

void ClosedLoop::write_down() noexcept {
  Parts& parts = *parts_;
  if (parts.log == nullptr || !parts.log_problem.empty()) return;
  try {
    for (const LawSnapshot* snapshot : snapshots()) {
      if (snapshot != nullptr) parts.log->write(*snapshot);
    }
    parts.log->write(parts.row);
  } catch (const LogError& error) {
    parts.log_problem = error.what();
  }
}

std::unique_ptr<RowLog> ClosedLoop::set_log(std::unique_ptr<RowLog> log) {
  parts_->log_problem.clear();
  return std::exchange(parts_->log, std::move(log));
}

const std::string& ClosedLoop::log_problem() const noexcept {
  return parts_->log_problem;
}

void ClosedLoop::reset() {
  Parts& parts = *parts_;
  parts.hand_over();
  parts.faults = {};
  parts.driver.inject(parts.faults);
  parts.machine->start();
  parts.driver.set_start(parts.driver.next_stamp_ns());
  parts.driver.begin_run(parts.driver.run() + 1);
}

void ClosedLoop::set_parameters(const std::string& request) {
  if (parts_->retuner == nullptr) throw ParameterError("this robot has no parameters that change while it runs");
  parts_->retuner->set(request);
  parts_->parameters = parts_->retuner->in_force();
}

void ClosedLoop::inject_fault(const std::string& component, const std::string& kind) {
  const std::string problem = set_fault(parts_->faults, parts_->robot.machine(), component, kind);
  if (problem.empty()) return parts_->driver.inject(parts_->faults);
  const std::string device_problem = parts_->inject_device(component, kind);
  if (!device_problem.empty()) throw std::invalid_argument(problem + "; of a device: " + device_problem);
}

std::uint64_t ClosedLoop::cycle() const noexcept {
  return parts_->driver.next_cycle();
}
double ClosedLoop::time() const noexcept {
  return row_time(cycle(), parts_->parameters.loop.period());
}
const JoinedRow& ClosedLoop::row() const noexcept {
  return parts_->row;
}
LaserScan ClosedLoop::scan() const {
  Simulator* const simulator = simulator_of(*parts_->machine);
  return simulator == nullptr ? LaserScan{} : simulator->scan(parts_->driver.trace().truth);
}
std::array<const LawSnapshot*, kLaws> ClosedLoop::snapshots() const noexcept {
  const JoinedRow::Laws& laws = parts_->row.laws;
  return {parts_->driver.snapshot(), laws.estimator != nullptr ? parts_->estimator.snapshot() : nullptr,
          laws.controller != nullptr ? parts_->controller.snapshot() : nullptr,
          laws.monitor != nullptr ? parts_->monitor.snapshot() : nullptr};
}
const Robot& ClosedLoop::robot() const noexcept {
  return parts_->robot;
}
const Parameters& ClosedLoop::parameters() const noexcept {
  return parts_->parameters;
}

}  // namespace robot_control
