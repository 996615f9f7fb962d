#pragma once
/// The robots on legs of the tests, by name.

#include <gtest/gtest.h>

#include <string>

#include "machine/legs/legs_corpus.h"
#include "support/robots/quadruped_loop.h"

namespace robot_control {

inline QuadrupedLoop loop_of(const std::string& name, std::uint64_t seed = 0, ErrorLevel errors = ErrorLevel::kIdeal) {
  return QuadrupedLoop(legged_robot(name), seed, errors);
}

}  // namespace robot_control
