#pragma once
/// Measures the speed of virtual time, in simulated seconds per second. It compares the bare physics engine, the loop
/// in one process, and the four nodes in lockstep.

#include <cstdint>

#include "drivers/mujoco/model/mujoco_model.h"
#include "rt/clock.h"
#include "simulation/closed_loop.h"
#include "support/processes/four_nodes.h"

namespace robot_control {

inline double simulated_per_second(const Parameters& parameters, std::uint64_t cycles, std::int64_t start_ns) {
  const double real = static_cast<double>(monotonic_ns() - start_ns) * 1e-9;
  return static_cast<double>(cycles) * parameters.loop.period() / real;
}

/// `mj_step` of the same model with native friction, wheels driven by a constant torque.
inline double bare_loop_speed(const Parameters& parameters, const DriveTrain& robot, std::uint64_t cycles) {
  constexpr double kTorque = 0.05;  // N·m
  MujocoPlantParameters native = parameters.plant;
  native.tyre = TyreModel::kNative;
  const MujocoModel model = compile_model(robot, native, parameters.loop.period());
  const MujocoData data = set_down(model);
  const std::int64_t start_ns = monotonic_ns();
  for (std::uint64_t k = 0; k < cycles; ++k) {
    for (const int address : model.joint_velocity) data->qfrc_applied[address] = kTorque;
    for (int step = 0; step < model.substeps; ++step) mj_step(model.model.get(), data.get());
  }
  return simulated_per_second(parameters, cycles, start_ns);
}

inline double closed_loop_speed(const Parameters& parameters, std::uint64_t cycles) {
  ClosedLoop loop(parameters);
  const std::int64_t start_ns = monotonic_ns();
  for (std::uint64_t k = 0; k < cycles; ++k) {
    if (k % 500 == 0) loop.command({.linear = {0.5, 0, 0}, .angular = {0, 0, 0.2}});
    loop.step();
  }
  return simulated_per_second(parameters, cycles, start_ns);
}

inline double four_nodes_speed(Parameters parameters, const DriveTrain& robot, std::uint64_t cycles) {
  constexpr double kTimeout = 120;  // s
  parameters.loop.clock = ClockMode::kLockstep;
  parameters.loop.wait_for_telemetry = false;
  parameters.plant.cycles = cycles;
  return FourNodes(parameters, robot, false).run(kTimeout);
}

}  // namespace robot_control
