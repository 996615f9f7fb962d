#include "control/wheeled/limits/limiter_properties.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <sstream>

#include "control/wheeled/limits/speed_limiter.h"
#include "signals/command_frame.h"

namespace robot_control {
namespace {

constexpr double kLimitRounding = 1e-9;

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : random_(seed) {}
  double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  double of_scale(double low, double high) { return std::exp(between(std::log(low), std::log(high))); }
  bool happens(double probability) { return between(0, 1) < probability; }

 private:
  std::mt19937_64 random_;
};

MotionLimits draw_limits(Draw& draw) {
  MotionLimits limits;
  limits.speed = draw.of_scale(0.1, 5);
  limits.acceleration = draw.of_scale(0.1, 20);
  limits.deceleration = draw.of_scale(0.1, 20);
  limits.emergency_deceleration = limits.deceleration * draw.of_scale(1, 5);
  if (draw.happens(0.8)) limits.jerk = draw.of_scale(0.5, 500);
  if (draw.happens(0.3)) limits.reverse_speed = draw.happens(0.2) ? 0 : limits.speed * draw.of_scale(0.02, 1);
  if (draw.happens(0.3)) limits.reverse_acceleration = draw.of_scale(0.1, 20);
  if (draw.happens(0.3)) {
    limits.reverse_deceleration = draw.of_scale(0.1, 20);
    limits.emergency_deceleration = std::max(limits.emergency_deceleration, *limits.reverse_deceleration);
  }
  return limits;
}

/// Forward and reverse exchanged.
MotionLimits mirrored(const MotionLimits& limits) {
  MotionLimits other = limits;
  other.speed = limits.speed_towards(-1);
  other.acceleration = limits.acceleration_towards(-1);
  other.deceleration = limits.deceleration_from(-1);
  other.reverse_speed = limits.speed;
  other.reverse_acceleration = limits.acceleration;
  other.reverse_deceleration = limits.deceleration;
  return other;
}

double draw_wish(Draw& draw, double limit) {
  if (draw.happens(0.3)) return 0;
  if (draw.happens(0.02)) return draw.of_scale(1e-323, 1e-300) * (draw.happens(0.5) ? 1 : -1);
  return limit * (draw.happens(0.15) ? draw.between(-0.02, 0.02) : draw.between(-1.3, 1.3));
}

/// One axis from cycle to cycle.
struct Axis {
  MotionLimits limits;
  double dt = 0;
  double speed = 0;
  double acceleration = 0;
  double goal = 0;
  double low = 0;   ///< lower end of the range until the next command
  double high = 0;  ///< its upper end; the range holds start, goal and the point at which the acceleration fades
  bool emergency_fades = false;
  bool yielded_before = false;

  void aim(double at) {
    const double fades = std::isinf(limits.jerk) ? 0 : acceleration * std::abs(acceleration) / (2 * limits.jerk);
    goal = at;
    low = std::min({speed, goal, speed + fades});
    high = std::max({speed, goal, speed + fades});
  }

  /// Goes on to `next` and returns the name of the violated property; null if there is none.
  const char* go(double next, bool emergency, bool yielded) {
    const double step = (next - speed) / dt;
    const double grain = 1e-12 * limits.speed / dt;  // of a difference of two speeds
    const double tolerance = kLimitRounding * (1 + std::abs(step)) + grain;
    const double slows = emergency ? limits.emergency_deceleration : limits.deceleration_from(speed);
    const auto side = [](double value) { return (value > 0) - (value < 0); };
    const bool crosses = side(speed) * side(next) < 0 && std::abs(next) > grain * dt;
    const bool slower = !crosses && std::abs(next) <= std::abs(speed);
    double bound = slower ? slows : limits.acceleration_towards(next - speed);
    if (emergency_fades && !std::isinf(limits.jerk)) {
      bound = std::max(bound, std::abs(acceleration) - limits.jerk * dt);
    }
    const double change = std::min(std::abs(step - acceleration), yielded_before ? std::abs(step) : INFINITY) / dt;
    const bool jerks = change > limits.jerk * (1 + kLimitRounding) + 2 * grain / dt;

    const char* violated = std::isfinite(next) ? nullptr : "finite";
    if (std::abs(next) > limits.speed_towards(next) * (1 + 1e-12)) violated = "speed";
    if (std::abs(step) > bound + tolerance) violated = "acceleration";
    if (jerks && !(yielded && next == 0)) violated = "jerk";
    if (side(next) != 0 && side(next) != side(goal) && side(next) != side(speed)) violated = "zero";
    if (next < low - kLimitRounding - grain * dt || next > high + kLimitRounding + grain * dt) violated = "overshoot";

    emergency_fades =
        emergency || (emergency_fades && std::abs(step) > limits.deceleration_from(speed) * (1 + kLimitRounding));
    acceleration = step;
    yielded_before = yielded && next == 0;  // this axis, or the other while this one passed zero
    speed = next;
    return violated;
  }

  /// Cycles within which it must arrive from anywhere: the acceleration fades, it slows down and speeds up.
  double patience() const {
    const double gentlest = std::min(limits.acceleration, limits.acceleration_towards(-1));
    const double slowest = std::min(limits.deceleration, limits.deceleration_from(-1));
    const double strongest =
        std::max({limits.acceleration, limits.acceleration_towards(-1), limits.emergency_deceleration});
    const double fading = std::isinf(limits.jerk) ? 0 : strongest / limits.jerk;
    return (limits.speed / gentlest + limits.speed / slowest + 8 * fading) / dt + 10;
  }
};

/// The limiter and its mirror image.
class Trial {
 public:
  explicit Trial(std::uint64_t seed)
      : draw_(seed),
        limits_{.linear = draw_limits(draw_), .angular = draw_limits(draw_), .keep_curvature = draw_.happens(0.5)},
        dt_(draw_.of_scale(5e-4, 1e-2)),
        axes_{{{.limits = limits_.linear, .dt = dt_}, {.limits = limits_.angular, .dt = dt_}}} {}

  std::optional<std::string> run() {
    for (cycle_ = 0; cycle_ < kLimiterCycles; ++cycle_) {
      const bool busy = cycle_ % 50 >= 25;
      if (cycle_ == 0 || draw_.happens(busy ? 0.2 : 0.02)) command();
      if (auto violated = step()) return violated;
    }
    return arrive();
  }

 private:
  void command() {
    emergency_ = draw_.happens(0.1);
    target_ = {draw_wish(draw_, limits_.linear.speed), draw_wish(draw_, limits_.angular.speed)};
    if (emergency_) target_ = {};
    const PlanarTwist goal = within_speed(target_, limits_);
    line_.reset();
    const bool steady = axes_[0].acceleration == 0 && axes_[1].acceleration == 0;
    if (limits_.keep_curvature && steady && !emergency_) {
      if (axes_[0].speed == 0 && axes_[1].speed == 0) line_ = goal;
      if (goal.linear == 0 && goal.angular == 0) line_ = {axes_[0].speed, axes_[1].speed};
    }
    axes_[0].aim(goal.linear);
    axes_[1].aim(goal.angular);
  }

  /// Beside the ray of commanded curvature, in units of its length times rad/s.
  bool beside_the_line(const PlanarTwist& at) const {
    if (!line_) return false;
    const double size = std::hypot(line_->linear, line_->angular);
    return std::abs(at.linear * line_->angular - at.angular * line_->linear) > kLimitRounding * size * size;
  }

  std::optional<std::string> step() {
    const PlanarTwist next = limiter_.step(target_, dt_, emergency_);
    const PlanarTwist mirrored = mirror_.step({-target_.linear, -target_.angular}, dt_, emergency_);
    const bool yielded = (limiter_.reasons() & kReasonJerkYielded) != 0;
    const std::array<double, 2> speeds{next.linear, next.angular};
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      const Axis before = axes_[i];
      if (const char* violated = axes_[i].go(speeds[i], emergency_, yielded))
        return report(violated, before, speeds[i]);
    }
    if (beside_the_line(next)) return report("curvature", axes_[1], next.angular);
    if (next.linear != -mirrored.linear || next.angular != -mirrored.angular) {
      return report("reverse", axes_[0], mirrored.linear);
    }
    return {};
  }

  std::optional<std::string> arrive() {
    // Together they take as long as the slower one, scaled up by the ratio of their ways.
    const double patience = 3 * (axes_[0].patience() + axes_[1].patience());
    for (; !arrived(); ++cycle_) {
      if (cycle_ > patience + kLimiterCycles) return report("arrival", axes_[0], axes_[0].speed);
      if (auto violated = step()) return violated;
    }
    for (int more = 0; more < 3; ++more, ++cycle_) {
      if (auto violated = step()) return violated;
      if (!arrived()) return report("arrival", axes_[0], axes_[0].speed);
    }
    return {};
  }

  bool arrived() const { return axes_[0].speed == axes_[0].goal && axes_[1].speed == axes_[1].goal; }

  std::string report(const char* violated, const Axis& axis, double next) const {
    std::ostringstream text;
    text << violated << " in cycle " << cycle_ << ", " << axis.speed << " to " << next << " for " << axis.goal
         << ", acceleration before " << axis.acceleration << "; limits " << axis.limits.acceleration << ", "
         << axis.limits.deceleration << ", " << axis.limits.emergency_deceleration << ", jerk " << axis.limits.jerk
         << ", dt " << dt_ << (limits_.keep_curvature ? ", together" : "");
    return text.str();
  }

  Draw draw_;
  SpeedLimits limits_;
  double dt_;
  std::array<Axis, 2> axes_;
  SpeedLimiter limiter_{limits_};
  SpeedLimiter mirror_{{.linear = mirrored(limits_.linear),
                        .angular = mirrored(limits_.angular),
                        .keep_curvature = limits_.keep_curvature}};
  PlanarTwist target_;
  std::optional<PlanarTwist> line_;  ///< the twist that it comes from, or goes to, straight from or to standstill
  bool emergency_ = false;
  int cycle_ = 0;
};

}  // namespace

std::optional<std::string> limiter_violation(std::uint64_t seed) {
  return Trial(seed).run();
}

}  // namespace robot_control
