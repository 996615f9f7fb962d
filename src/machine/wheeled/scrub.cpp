#include "machine/wheeled/scrub.h"

#include <algorithm>
#include <cmath>

#include "machine/gravity.h"

namespace robot_control {
namespace {

constexpr double kSlidingSlip = 0.05;  // κ
constexpr double kBlend = 0.005;       // m/s, ε
constexpr double kRelaxation = 0.1;    // share of a radius

}  // namespace

Scrub::Scrub(const DriveTrain& robot) noexcept
    : count_(std::min(robot.wheels.size(), kMaxWheels)), half_base_(0.5 * robot.effective_wheel_base()) {
  const double count = static_cast<double>(count_);
  double mean = 0;
  for (std::size_t i = 0; i < count_; ++i) mean += robot.wheels[i].centre_base[0] / count;
  double square = 0;
  for (std::size_t i = 0; i < count_; ++i) square += std::pow(robot.wheels[i].centre_base[0] - mean, 2) / count;
  const double ahead = robot.centre_of_gravity_base[0] - mean;
  const double along = half_base_ - 0.5 * robot.wheel_base;
  for (std::size_t i = 0; i < count_; ++i) {
    const WheelModel& wheel = robot.wheels[i];
    const double x = wheel.centre_base[0] - mean;
    const double side = wheel.side == Side::kLeft ? -1 : 1;
    wheels_[i] = {.lever = std::hypot(along, x),
                  .side = side,
                  .turn = side * wheel.sign,
                  .rim = 2 * wheel.sign * wheel.radius / count,
                  .distance = kSlidingSlip * kRelaxation * wheel.radius};
    if (!(square > 0) || !(along > 0)) continue;
    const double load = robot.mass * kGravity / count * std::max(0.0, 1 + ahead * x / square);
    wheels_[i].effort = wheel.radius * load * along / wheels_[i].lever;
  }
}

std::array<double, kMaxWheels> Scrub::efforts(double linear, double angular) const noexcept {
  std::array<double, kMaxWheels> efforts{};
  for (std::size_t i = 0; i < count_; ++i) {
    const Wheel& wheel = wheels_[i];
    if (wheel.effort == 0) continue;
    const double slide = angular * wheel.lever;
    const double rolling = kSlidingSlip * (linear + wheel.side * half_base_ * angular);
    efforts[i] = wheel.turn * wheel.effort * slide / std::sqrt(slide * slide + rolling * rolling + kBlend * kBlend);
  }
  return efforts;
}

double Scrub::strain(std::array<double, kMaxWheels>& efforts, double linear, double angular, double dt) const noexcept {
  double slid = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    const Wheel& wheel = wheels_[i];
    if (wheel.effort == 0) continue;
    const double slide = dt * angular * wheel.lever;
    const double rolling = dt * kSlidingSlip * (linear + wheel.side * half_base_ * angular);
    const double relaxed = std::sqrt(slide * slide + rolling * rolling);
    efforts[i] = (wheel.distance * efforts[i] + wheel.turn * wheel.effort * slide) / (wheel.distance + relaxed);
    slid += relaxed;
  }
  return slid / static_cast<double>(count_);
}

std::array<double, kMaxWheels> Scrub::efforts(const std::array<double, kMaxWheels>& speeds) const noexcept {
  double linear = 0;
  double difference = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    const double rim = wheels_[i].rim * speeds[i];
    linear += 0.5 * rim;
    difference += wheels_[i].side * rim;
  }
  return efforts(linear, 0.5 * difference / half_base_);
}

}  // namespace robot_control
