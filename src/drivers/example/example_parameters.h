#pragma once

#include <cstdint>
#include <string>

#include "parameters/block.h"

namespace robot_control {

struct ExampleParameters {
  std::string address;            ///< path of the board's socket
  std::uint64_t max_silence = 3;  ///< reports in a row that may be missing
};

inline Keys keys(ExampleParameters& board) {
  return {{"address", &board.address}, {"max_silence", &board.max_silence, {}, 1, 100, kOptional}};
}

}  // namespace robot_control
