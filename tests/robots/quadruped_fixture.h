#pragma once
/// The robots on legs of the tests, by name.

#include "machine/legs/legs_corpus.h"
#include "support/robots/quadruped_loop.h"

namespace robot_control {

/// Quadbot, unless another one is named, with these parameters; it lies, and the loop is closed.
inline QuadrupedLoop loop_of(const Parameters& parameters, const std::string& name = "quadbot") {
  QuadrupedLoop robot(legged_robot(name), parameters);
  robot.wait(0.3);
  return robot;
}
inline QuadrupedLoop loop_of(const std::string& name, std::uint64_t seed = 0, ErrorLevel errors = ErrorLevel::kIdeal) {
  return loop_of(QuadrupedLoop::parameters(seed, errors), name);
}

/// A request of a twist, m/s and rad/s.
inline Request walk(double linear, double lateral = 0, double angular = 0, const Mode& mode = {}) {
  return {.twist = {.linear = {linear, lateral, 0}, .angular = {0, 0, angular}}, .posture = {}, .mode = mode};
}

/// Quadbot, which walks with 0.5 m/s.
inline QuadrupedLoop walking() {
  QuadrupedLoop robot = loop_of("quadbot");
  robot.run(4.5, walk(0.5));
  return robot;
}

}  // namespace robot_control
