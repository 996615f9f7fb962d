#include "simulation/closed_loop.h"

#include <stdexcept>
#include <utility>

#include "log/log_error.h"
#include "loop/gate_setup.h"
#include "machine/fault_names.h"
#include "robots/robot_kind.h"
#include "signals/names.h"
#include "simulation/machines/simulated_machine.h"

namespace robot_control {
namespace {

constexpr std::uint64_t kDriverInstance =
    1;  // any number except 0; the same applies to a run: no other process uses these channels

/// Reads the command script. ClosedLoop is the only sender of commands, so each run begins with a zero request.
CommandScript script_of(const Parameters& parameters, const Robot& robot) {
  CommandScript script = load_script(parameters.loop.command_script, robot.executable());
  script.begin_with_zero();
  return script;
}

/// The robot of the parameters, unless it is given.
std::shared_ptr<const Robot> drivable(std::shared_ptr<const Robot> robot, const Parameters& parameters) {
  if (robot == nullptr) robot = make_robot(parameters);
  robot->require_drivable();
  return robot;
}

std::unique_ptr<Driver> copy_of(Driver& machine) {
  Simulator* const simulator = simulator_of(machine);
  std::unique_ptr<Driver> copy = simulator == nullptr ? nullptr : simulator->clone();
  if (copy != nullptr) return copy;
  throw DriverError(
      "a loop with simulated drives (robot.drives) cannot be cloned; create another one with the same arguments and "
      "repeat the calls");
}

}  // namespace

ClosedLoop::ClosedLoop(const Parameters& given, std::shared_ptr<const Robot> robot, std::unique_ptr<Driver> machine)
    : parameters_(robot != nullptr || given.drives.empty() ? given
                                                           : limited_by_drives(given, load_description(given.urdf))),
      robot_(drivable(std::move(robot), parameters_)),
      machine_(machine != nullptr ? std::move(machine)
                                  : make_simulated_machine(parameters_, robot_->machine(), robot_->brakes())),
      driver_(*machine_, robot_->machine(),
              {sensors_.writer, FrameWriter<TruthFrame>(), &command_.reader, &permit_.reader},
              parameters_.loop.period_ns(), nullptr, robot_->gate()),
      estimator_(robot_->make_estimator(), robot_->machine().hash, sensors_.reader, state_.writer, nullptr),
      controller_(robot_->make_controller(), robot_->machine().hash,
                  {&sensors_.reader, &state_.reader, &permit_.reader, command_.writer}, script_of(parameters_, *robot_),
                  nullptr),
      monitor_(robot_->make_monitor(), robot_->machine().hash, 0,
               {&sensors_.reader, &state_.reader, &command_.reader, permit_.writer},
               load_script(parameters_.loop.command_script), nullptr),
      retuner_(robot_->make_retuner(controller_.tunings())) {
  require_needs(*machine_, robot_->needs());
  machine_->start();
  driver_.set_driver_instance(kDriverInstance);
  driver_.begin_run(1);
}

ClosedLoop::ClosedLoop(const ClosedLoop& other)
    : parameters_(other.parameters_),
      robot_(other.robot_),
      machine_(copy_of(*other.machine_)),
      sensors_(other.sensors_),
      state_(other.state_),
      command_(other.command_),
      permit_(other.permit_),
      driver_(other.driver_, *machine_,
              {sensors_.writer, FrameWriter<TruthFrame>(), &command_.reader, &permit_.reader}),
      estimator_(other.estimator_, sensors_.reader, state_.writer),
      controller_(other.controller_, {&sensors_.reader, &state_.reader, &permit_.reader, command_.writer}),
      monitor_(other.monitor_, {&sensors_.reader, &state_.reader, &command_.reader, permit_.writer}),
      estimator_faults_(other.estimator_faults_, state_.writer),
      controller_faults_(other.controller_faults_, command_.writer),
      monitor_faults_(other.monitor_faults_, permit_.writer),
      retuner_(other.retuner_ == nullptr ? nullptr : other.retuner_->clone(controller_.tunings())),
      request_(other.request_),
      mode_(other.mode_),
      operator_input_(other.operator_input_),
      faults_(other.faults_),
      fresh_(other.fresh_),
      handed_over_(other.handed_over_) {}

void ClosedLoop::clearance(double metres) noexcept {
  ++operated().clearances;
  operator_input_.clearance = metres;
}

void ClosedLoop::hand_over() noexcept {
  if (handed_over_) return;
  controller_.inbox().store(request_);
  monitor_.inbox().store(operator_input_);
  handed_over_ = true;
}

void ClosedLoop::step() noexcept {
  fresh_ = false;
  if (cycle() > 0) hand_over();  // every node drops inputs that arrive before a run begins
  driver_.step();
  const SensorFrame& sensors = driver_.trace().sensors;
  JoinedRow::Laws laws;
  if (estimator_.step()) laws.estimator = estimator_faults_.replace(sensors, estimator_.trace());
  if (controller_.step()) laws.controller = controller_faults_.replace(sensors, controller_.trace());
  const bool granted = monitor_.permit().action == PermitAction::kDrive;
  if (monitor_.step()) laws.monitor = monitor_faults_.replace(sensors, monitor_.trace());
  if (granted && monitor_.permit().action != PermitAction::kDrive) mode_ = {};
  row_ = {.run = static_cast<std::int64_t>(driver_.run()) - 1,
          .cycle = sensors.head.cycle,
          .time = row_time(sensors.head.cycle, parameters_.loop.period()),
          .driver = &driver_.trace()};
  row_.set(laws);
  write_down();
}

void ClosedLoop::write_down() noexcept {
  if (log_ == nullptr || !log_problem_.empty()) return;
  try {
    for (const LawSnapshot* snapshot : snapshots()) {
      if (snapshot != nullptr) log_->write(*snapshot);
    }
    log_->write(row_);
  } catch (const LogError& error) {
    log_problem_ = error.what();
  }
}

void ClosedLoop::record() noexcept {
  sensors_.frames->seal_all();
  state_.frames->seal_all();
  command_.frames->seal_all();
  permit_.frames->seal_all();
}

std::unique_ptr<RowLog> ClosedLoop::set_log(std::unique_ptr<RowLog> log) {
  fresh_ = false;
  if (log != nullptr) record();
  log_problem_.clear();
  return std::exchange(log_, std::move(log));
}

void ClosedLoop::reset() {
  fresh_ = false;
  hand_over();
  faults_ = {};
  driver_.inject(faults_);
  machine_->start();
  driver_.set_start(driver_.next_stamp_ns());
  driver_.begin_run(driver_.run() + 1);
}

void ClosedLoop::set_parameters(const std::string& request) {
  if (retuner_ == nullptr) throw ParameterError("this robot has no parameters that change while it runs");
  fresh_ = false;
  retuner_->set(request);
  parameters_ = retuner_->in_force();
}

void ClosedLoop::inject_fault(const std::string& component, const std::string& kind) {
  fresh_ = false;
  const std::string problem = set_fault(faults_, robot_->machine(), component, kind);
  if (problem.empty()) return driver_.inject(faults_);
  Simulator* const simulator = simulator_of(*machine_);
  const std::string device_problem =
      simulator == nullptr ? "no device is simulated" : simulator->inject_device(component, kind);
  if (!device_problem.empty()) throw std::invalid_argument(problem + "; of a device: " + device_problem);
}

LaserScan ClosedLoop::scan() const {
  Simulator* const simulator = simulator_of(*machine_);
  return simulator == nullptr ? LaserScan{} : simulator->scan(driver_.trace().truth);
}
std::array<const LawSnapshot*, kLaws> ClosedLoop::snapshots() const noexcept {
  const JoinedRow::Laws& laws = row_.laws;
  return {driver_.snapshot(), laws.estimator != nullptr ? estimator_.snapshot() : nullptr,
          laws.controller != nullptr ? controller_.snapshot() : nullptr,
          laws.monitor != nullptr ? monitor_.snapshot() : nullptr};
}

}  // namespace robot_control
