#include "drivers/mujoco/contact/slip_noise.h"

#include <cmath>

namespace robot_control {

SlipNoise::SlipNoise(std::size_t wheels, const MujocoPlantParameters& parameters)
    : seed_(parameters.seed),
      deviation_(parameters.sensor_errors == ErrorLevel::kField && wheels > 2
                     ? parameters.wheel_slip_noise / std::sqrt(2 * kLength)
                     : 0) {
  reset();
}

void SlipNoise::reset() {
  random_[0].seed(seed_, kLeftSlipStream);
  random_[1].seed(seed_, kRightSlipStream);
  error_ = {};
}

void SlipNoise::step(std::size_t side, double distance) noexcept {
  if (deviation_ == 0 || distance == 0) return;
  const double kept = std::exp(-std::abs(distance) / kLength);
  double& error = error_[side];
  error = kept * error + deviation_ * std::sqrt(1 - kept * kept) * random_[side].next();
}

}  // namespace robot_control
