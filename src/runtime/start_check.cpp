#include "runtime/start_check.h"

#include <bit>
#include <cmath>
#include <string>

#include "control/control_problems.h"

namespace robot_control {

void require_drivable(const Parameters& parameters, const RobotModel& robot) {
  std::string message;
  for (const std::string& problem : control_problems(parameters.controller, robot, parameters.loop.period())) {
    message += (message.empty() ? "" : "\n") + problem;
  }
  if (!message.empty()) throw ParameterError(message);
}

RobotModel identified(const RobotModel& robot, const LoopParameters& loop) {
  constexpr std::uint64_t kOdd = 0x9E3779B97F4A7C15ULL;  // 2^64 / golden ratio, odd
  const auto mix = [](std::uint64_t hash, std::uint64_t word) { return std::rotl((hash ^ word) * kOdd, 29); };
  const bool lockstep = loop.clock == ClockMode::kLockstep;
  RobotModel result = robot;
  result.hash = mix(mix(robot.hash, static_cast<std::uint64_t>(loop.period_ns())), lockstep ? 1 : 2);
  result.source += " at " + std::to_string(std::lround(loop.rate)) + " Hz, clock " + (lockstep ? "lockstep" : "wall");
  return result;
}

}  // namespace robot_control
