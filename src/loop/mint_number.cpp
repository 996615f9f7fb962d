#include "loop/mint_number.h"

#include <random>

namespace robot_control {

std::uint64_t mint_number() {
  std::random_device device;
  std::uint64_t number = 0;
  while (number == 0) number = (std::uint64_t{device()} << 32) | device();
  return number;
}

}  // namespace robot_control
