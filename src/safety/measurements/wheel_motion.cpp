#include "safety/measurements/wheel_motion.h"

#include <algorithm>
#include <cmath>

#include "safety/derived_limits.h"

namespace robot_control {

WheelMotion::WheelMotion(std::size_t wheels, double period) noexcept
    : wheels_(std::min(wheels, kMaxWheels)),
      period_(period),
      window_cycles_(std::clamp<std::uint64_t>(static_cast<std::uint64_t>(std::ceil(kSpeedWindow / period - 1e-9)), 2,
                                               kMaxWindow)),
      window_(static_cast<double>(window_cycles_) * period) {}

void WheelMotion::enter_run() noexcept {
  sampled_ = speed_known_ = acceleration_known_ = stepped_ = false;
  newest_ = kNoCycle;
  angle_ = last_step_ = speed_ = acceleration_ = quantum_ = speed_tolerance_ = acceleration_tolerance_ = {};
  for (Sample& sample : samples_) sample.cycle = kNoCycle;
}

void WheelMotion::step(const SensorFrame& sensors) noexcept {
  speed_known_ = acceleration_known_ = false;
  sampled_ = read_angles(sensors);
  if (!sampled_) return;
  const Sample* const middle = before(newest_);
  if (middle == nullptr) return;
  const double recent = static_cast<double>(newest_ - middle->cycle) * period_;
  for (std::size_t i = 0; i < wheels_; ++i) speed_[i] = (angle_[i] - middle->angle[i]) / recent;
  speed_known_ = true;
  const Sample* const oldest = before(middle->cycle);
  if (oldest == nullptr) return;
  const double earlier = static_cast<double>(middle->cycle - oldest->cycle) * period_;
  for (std::size_t i = 0; i < wheels_; ++i) {
    acceleration_[i] = (speed_[i] - (middle->angle[i] - oldest->angle[i]) / earlier) / recent;
  }
  acceleration_known_ = true;
}

bool WheelMotion::read_angles(const SensorFrame& sensors) noexcept {
  if (!joints_have(sensors, wheels_, kValidPosition)) return false;
  Values angle{};
  bool all_finite = true;
  for (std::size_t i = 0; i < wheels_; ++i) {
    angle[i] = sensors.joints[i].position;
    all_finite = all_finite && std::isfinite(angle[i]);
  }
  if (!all_finite) return false;
  if (newest_ != kNoCycle) refine_quanta(angle);
  newest_ = sensors.head.cycle;
  angle_ = angle;
  samples_[newest_ % kSlots] = {newest_, angle};
  return true;
}

void WheelMotion::refine_quantum(std::size_t wheel, double candidate) noexcept {
  double& quantum = quantum_[wheel];
  if (candidate <= kMinQuantum || (quantum != 0 && candidate >= quantum)) return;
  quantum = candidate;
  speed_tolerance_[wheel] = quantum / window_;
  acceleration_tolerance_[wheel] = 2 * quantum / (window_ * window_);
}

void WheelMotion::refine_quanta(const Values& angle) noexcept {
  for (std::size_t i = 0; i < wheels_; ++i) {
    const double step = angle[i] - angle_[i];
    refine_quantum(i, std::abs(step));
    if (stepped_) refine_quantum(i, std::abs(step - last_step_[i]));
    last_step_[i] = step;
  }
  stepped_ = true;
}

const WheelMotion::Sample* WheelMotion::before(std::uint64_t cycle) const noexcept {
  for (std::uint64_t age = window_cycles_; age <= 2 * window_cycles_ && age <= cycle; ++age) {
    const Sample& sample = samples_[(cycle - age) % kSlots];
    if (sample.cycle == cycle - age) return &sample;
  }
  return nullptr;
}

}  // namespace robot_control
