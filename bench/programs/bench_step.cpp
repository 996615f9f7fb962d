/// bench_step PARAMS.yaml: measures the cost of one step of each law, without frame transport, and its allocations.
///
/// Inputs are the frames of a real drive (the closed loop at 0.5 m/s, 0.2 rad/s), replayed in blocks. The estimator's
/// are those of its steady part, in which both encoders and both contacts correct it in every cycle. The reference is a
/// fixed arithmetic kernel (a chain of dependent multiply-adds), interleaved block by block. The cycle of motor drives
/// on CAN is compared with bare system calls (can_cycle.h). That of boards on a serial line is compared with what is
/// allowed (serial_cycle.h), as is that of the motors of legs (leg_cycle.h).

#include <filesystem>
#include <string>
#include <vector>

#include "bench/programs/can_cycle.h"
#include "bench/programs/kernel.h"
#include "bench/programs/leg_cycle.h"
#include "bench/programs/rows.h"
#include "bench/programs/serial_cycle.h"
#include "control/wheeled/drive_controller.h"
#include "drivers/board/board_machine.h"
#include "drivers/roboclaw/roboclaw_machine.h"
#include "drivers/table/drive_table.h"
#include "drivers/table/read_drive_file.h"
#include "estimation/wheeled/estimator.h"
#include "gate/gate.h"
#include "loop/gate_setup.h"
#include "robots/robot_kind.h"
#include "rt/clock.h"
#include "safety/conditions/wheeled/wheeled_conditions.h"
#include "simulation/closed_loop.h"
#include "support/allocation_guard.h"

namespace robot_control::bench {

constexpr std::size_t kRecorded = 2000;  // cycles replayed in one block
constexpr int kBlocks = 101;

struct Drive {
  std::vector<SensorFrame> sensors;
  std::vector<StateFrame> states;
  std::vector<CommandFrame> commands;
  std::vector<Permit> permits;
};

Drive record(ClosedLoop& loop) {
  Drive drive;
  for (std::size_t k = 0; k < kRecorded; ++k) {
    loop.command({.linear = {0.5, 0, 0}, .angular = {0, 0, 0.2}});
    loop.step();
    drive.sensors.push_back(loop.row().driver->sensors);
    drive.states.push_back(loop.row().estimator->state);
    drive.commands.push_back(loop.row().controller->command);
    drive.permits.push_back(loop.row().monitor->permit);
  }
  return drive;
}

/// Sensors of the next cycles of the same drive.
std::vector<SensorFrame> record_sensors(ClosedLoop& loop) {
  std::vector<SensorFrame> sensors;
  for (std::size_t k = 0; k < kRecorded; ++k) {
    loop.command({.linear = {0.5, 0, 0}, .angular = {0, 0, 0.2}});
    loop.step();
    sensors.push_back(loop.row().driver->sensors);
  }
  return sensors;
}

/// ns per step, one entry per block, and the allocations of the last block.
struct Timing {
  std::vector<double> step_ns;
  std::vector<double> kernel_ns;
  std::uint64_t allocations = 0;
};

template <class Reset, class Step>
Timing measure(Reset reset, Step step) {
  Timing timing;
  for (int block = 0; block < kBlocks; ++block) {
    timing.kernel_ns.push_back(kernel_block(kRecorded));
    reset();
    const AllocationGuard guard;
    const std::int64_t start = monotonic_ns();
    for (std::size_t k = 1; k < kRecorded; ++k) step(k);
    timing.step_ns.push_back(static_cast<double>(monotonic_ns() - start) / (kRecorded - 1));
    timing.allocations = guard.count();
  }
  return timing;
}

void add(std::vector<Row>& rows, const std::string& name, const Timing& timing) {
  rows.push_back({name + " step", median(timing.step_ns), "ns", median(timing.kernel_ns), "kernel of 64 multiply-adds",
                  median_ratio(timing.step_ns, timing.kernel_ns)});
  rows.push_back({name + " allocations", static_cast<double>(timing.allocations), "per block of 2000", 0, "none", 0});
}

/// The drivers of legs, each with its motors in quadbot.
void add_leg_cycles(std::vector<Row>& rows, const std::filesystem::path& config, Parameters parameters) {
  parameters.urdf = config.parent_path() / "urdf" / "quadbot.urdf";
  const std::unique_ptr<Robot> robot = make_robot(parameters);
  const DriveMotors motors = drive_motors(robot->machine(), robot->brakes());
  for (const DriveRow& row : kDriveRows) {
    if (row.command != "impedance") continue;
    const std::string file = config / "drives" / (std::string(row.name) + ".yaml");
    const auto read = read_drive_file(file, row.driver, {.joints = motors.joints, .rate = parameters.loop.rate});
    add_leg_cycle(rows, std::string(row.name), *read, motors);
  }
}

void run(const std::string& path) {
  const Parameters parameters = read_parameters(path);
  ClosedLoop loop(parameters);
  const DriveTrain& robot = drive_train_of(loop.robot().machine());
  const double period = parameters.loop.period();
  const Drive drive = record(loop);
  std::vector<Row> rows;

  const std::vector<SensorFrame> curve = record_sensors(loop);
  Estimator moving(parameters.estimator, robot, period);
  StateFrame state;
  for (const SensorFrame& sensors : drive.sensors) moving.step(sensors, state);
  Estimator estimator = moving;
  add(rows, "estimator",
      measure([&] { estimator = moving; }, [&](std::size_t k) { estimator.step(curve[k - 1], state); }));

  DriveController controller(parameters.controller, robot, period);
  CommandFrame command;
  add(rows, "controller",
      measure([&] { controller.enter_run(); },
              [&](std::size_t k) {
                const VelocityCommand request{.content = drive.commands[k].requested, .count = k};
                controller.step({.sensors = &drive.sensors[k],
                                 .state = &drive.states[k],
                                 .permit = &drive.permits[k - 1],
                                 .request = request},
                                command);
              }));

  Gate gate(joint_limits(robot), loop.robot().gate(), period);
  add(rows, "gate",
      measure([&] { gate.enter_run(); },
              [&](std::size_t k) {
                gate.step({.run = drive.sensors[k].head.run,
                           .cycle = k,
                           .permit_found = Lookup::kFrame,
                           .permit = &drive.permits[k - 1],
                           .command_found = Lookup::kFrame,
                           .command = &drive.commands[k - 1],
                           .sensors = &drive.sensors[k]});
              }));

  const SafetyMonitor started(parameters.safety, robot, period);
  SafetyMonitor monitor = started;
  Permit permit;
  add(rows, "monitor",
      measure([&] { monitor = started; },
              [&](std::size_t k) {
                monitor.step({.sensors = &drive.sensors[k],
                              .command = &drive.commands[k - 1],
                              .state = &drive.states[k - 1],
                              .operator_input = {}},
                             permit);
              }));

  const std::filesystem::path config = std::filesystem::path(path).parent_path();
  std::vector<std::string> joints;
  for (const WheelModel& wheel : robot.wheels) joints.push_back(robot.joints[wheel.joint].name);
  for (const DriveRow& row : kDriveRows) {
    if (row.command == "impedance") continue;
    const std::string file = config / "drives" / (std::string(row.name) + ".yaml");
    const auto read = read_drive_file(file, row.driver, {.joints = joints, .rate = parameters.loop.rate});
    if (const auto* can = dynamic_cast<const CanDriveFile*>(read.get()))
      add_can_cycle(rows, std::string(row.name), *can, robot, period);
  }
  add_leg_cycles(rows, config, parameters);
  add_serial_cycle<BoardMachine>(rows, "board", {.mode = JointMode::kEffort, .effort = 0});
  add_serial_cycle<RoboclawMachine>(rows, "roboclaw", {.mode = JointMode::kDriveVelocity, .velocity = 5});
  print("step", rows);
}

}  // namespace robot_control::bench

int main(int argc, char** argv) {
  return robot_control::bench::run_with_parameters(argc, argv, robot_control::bench::run);
}
