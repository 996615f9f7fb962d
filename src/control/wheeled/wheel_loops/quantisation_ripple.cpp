#include "control/wheeled/wheel_loops/quantisation_ripple.h"

#include <cmath>
#include <cstdint>
#include <numbers>

namespace robot_control {
namespace {

constexpr double kCutoffFrequency = 5.0;                    // Hz
constexpr double kRamp = 0.5, kFrom = 0.75, kUntil = 1.25;  // s
constexpr double kCount = 2 * std::numbers::pi / kCounts;   // rad

}  // namespace

double quantisation_ripple(const WheelLoopGains& gains, const WheelLoad& load, double bandwidth, double effort_limit,
                           double speed, double period) {
  WheelLoop loop(gains, bandwidth, effort_limit, period);
  const double follows = -std::expm1(-2 * std::numbers::pi * kCutoffFrequency * period);
  double angle = 0, velocity = 0;
  double acting = 0, next = 0;  // N·m, in this cycle and the next one
  double slow = 0, square = 0, count = 0;
  for (std::uint64_t cycle = 0; static_cast<double>(cycle) * period < kUntil; ++cycle) {
    const double time = static_cast<double>(cycle) * period;
    loop.measure({.position = std::round(angle / kCount) * kCount, .velocity = velocity, .effort = acting}, 1,
                 cycle > 0);
    acting = next;
    const double acceleration = time < kRamp ? speed / kRamp : 0;
    const double planned = time < kRamp ? acceleration * time : speed;
    next = loop.step({planned, acceleration, load.inertia * acceleration + load.damping * planned}, 1);
    // Damping is integrated implicitly, because it may be stiff against the period.
    const double reached = (velocity + period * acting / load.inertia) / (1 + period * load.damping / load.inertia);
    angle += 0.5 * period * (velocity + reached);
    velocity = reached;
    slow += follows * (next - slow);
    if (time < kFrom) continue;
    square += (next - slow) * (next - slow);
    ++count;
  }
  return std::sqrt(square / count);
}

}  // namespace robot_control
