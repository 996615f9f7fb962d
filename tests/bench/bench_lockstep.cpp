/// bench_lockstep PARAMS.yaml: the closed loop in virtual time against the bare physics engine.
///
/// Per round, one after the other: a bare loop of `mj_step` of the same model, the ClosedLoop in this process,
/// and four processes in lockstep (forked, on a bus of their own). Simulated seconds per second, median over
/// the rounds, and the ratio to the bare loop of the same round.

#include <iostream>
#include <string>
#include <vector>

#include "bench/rows.h"
#include "drivers/mujoco_model.h"
#include "rt/clock.h"
#include "simulation/closed_loop.h"
#include "support/four_nodes.h"

namespace robot_control::bench {
namespace {

constexpr int kRounds = 7;
constexpr std::uint64_t kCycles = 40'000;
constexpr double kPatience = 120;  // s until a round of four processes is given up

double simulated(const Parameters& parameters, std::int64_t start_ns) {
  const double real = static_cast<double>(monotonic_ns() - start_ns) * 1e-9;
  return static_cast<double>(kCycles) * parameters.loop.period() / real;
}

double bare_loop(const Parameters& parameters, const RobotModel& robot) {
  const MujocoModel model = compile_model(robot, parameters.plant, parameters.loop.period());
  const MujocoData data = set_down(model);
  const std::int64_t start_ns = monotonic_ns();
  for (std::uint64_t k = 0; k < kCycles; ++k) {
    for (const int address : model.joint_velocity) data->qfrc_applied[address] = 0.05;
    for (int step = 0; step < model.substeps; ++step) mj_step(model.model.get(), data.get());
  }
  return simulated(parameters, start_ns);
}

double closed_loop(const Parameters& parameters) {
  ClosedLoop loop(parameters);
  const std::int64_t start_ns = monotonic_ns();
  for (std::uint64_t k = 0; k < kCycles; ++k) {
    if (k % 500 == 0) loop.command({.linear = {0.5, 0, 0}, .angular = {0, 0, 0.2}});
    loop.step();
  }
  return simulated(parameters, start_ns);
}

double four_processes(Parameters parameters, const RobotModel& robot) {
  parameters.loop.clock = ClockMode::kLockstep;
  parameters.loop.wait_for_nodes = true;
  parameters.loop.wait_for_telemetry = false;
  parameters.plant.cycles = kCycles;
  return FourNodes(parameters, robot, false).run(kPatience);
}

int run(const std::string& path) {
  const Parameters parameters = read_parameters(path);
  const RobotModel robot = read_robot(load_description(parameters.urdf), parameters.robot);
  std::vector<double> bare;
  std::vector<double> closed;
  std::vector<double> four;
  for (int round = 0; round < kRounds; ++round) {
    bare.push_back(bare_loop(parameters, robot));
    closed.push_back(closed_loop(parameters));
    four.push_back(four_processes(parameters, robot));
  }
  const std::string unit = "simulated s per s";
  print("lockstep",
        {{"bare mj_step loop", median(bare), unit, median(bare), "itself", 1},
         {"ClosedLoop", median(closed), unit, median(bare), "bare mj_step loop", median_ratio(closed, bare)},
         {"four processes", median(four), unit, median(bare), "bare mj_step loop", median_ratio(four, bare)}});
  return 0;
}

}  // namespace
}  // namespace robot_control::bench

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: bench_lockstep PARAMS.yaml\n";
    return 2;
  }
  try {
    return robot_control::bench::run(argv[1]);
  } catch (const std::exception& error) {
    std::cerr << "bench_lockstep: " << error.what() << "\n";
    return 1;
  }
}
