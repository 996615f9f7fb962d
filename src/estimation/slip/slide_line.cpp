#include "estimation/slip/slide_line.h"

#include <algorithm>
#include <cmath>

namespace robot_control {

void SlideLine::begin(const MotionDifference::Point& older, const MotionDifference::Point& onset,
                      const AccelerationNoise& noise, double slope_deviation) noexcept {
  const double time = onset.time - older.time;
  slope_ = (onset.path_difference - older.path_difference) / time;
  begin_ = onset.time;
  deviation_ = std::sqrt(square(slope_deviation) + square(noise.slow * time / 2) + square(noise.white) * time / 3);
}

void SlideLine::renew(const Planar& change, double deviation) noexcept {
  slope_ = slope_ + change;
  deviation_ = deviation;
}

double SlideLine::speed_deviation(double time, const AccelerationNoise& noise) const noexcept {
  const double t = std::max(0.0, time - begin_);
  return std::sqrt(square(deviation_) + square(noise.slow * t) + square(noise.white) * t);
}

}  // namespace robot_control
