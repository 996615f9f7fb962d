#include "drivers/mujoco/sensors/normal_stream.h"

#include <cmath>

namespace robot_control {

void NormalStream::seed(std::uint64_t seed, std::uint64_t stream) {
  std::seed_seq words{seed & 0xFFFFFFFFu, seed >> 32, stream};
  engine_.seed(words);
  has_spare_ = false;
}

double NormalStream::next() noexcept {
  has_spare_ = !has_spare_;
  if (!has_spare_) return spare_;
  double x = 0, y = 0, square = 0;
  while (square == 0 || square >= 1) {
    x = uniform();
    y = uniform();
    square = x * x + y * y;
  }
  const double scale = std::sqrt(-2 * std::log(square) / square);
  spare_ = y * scale;
  return x * scale;
}

}  // namespace robot_control
