#pragma once
/// A rigid body on two wheels that roll without slip, on a slope that always falls against x of base.
///
///   (m + Σ J/r²)·v̇ = F + m·x_c·ω² − m·g·sin(slope)        F = Σ τ/r
///   (I + Σ J·b²/(4·r²))·ω̇ = M − m·x_c·v·ω                 M = (τ_right − τ_left)·b/(2·r)
///
/// Equal radii, wheels centred. Torque is constant over a step; v and ω move by their acceleration at its start.
/// `lifted_left` takes the left wheel off the ground: it then moves its own inertia alone, and the robot stands.

#include <cmath>
#include <numbers>

#include "control/wheeled/planar_twist.h"
#include "machine/wheeled/drive_train.h"

namespace robot_control {

class TwoWheelPlant {
 public:
  static constexpr double kGravity = 9.81;      ///< m/s²
  static constexpr double kBrakeDamping = 2.0;  ///< N·m·s/rad
  static constexpr double kBrakeHolds = 0.05;   ///< rad/s, below it the brake stands

  explicit TwoWheelPlant(const DriveTrain& robot) : robot_(robot) {}

  double slope = 0;             ///< rad
  double viscous_friction = 0;  ///< N·m·s/rad per wheel
  double counts = 0;            ///< per turn of the encoders; 0: exact angles
  bool lifted_left = false;
  PlanarTwist twist;    ///< true
  SidePair angle;       ///< rad, true
  SidePair speed;       ///< rad/s, true
  SidePair effort;      ///< N·m of the last step
  double distance = 0;  ///< m

  SidePair measured_angle() const { return {quantised(angle.left), quantised(angle.right)}; }

  void drive(const SidePair& torque, double dt) {
    const double r = robot_.wheels[0].radius;
    const double b = robot_.wheel_base;
    const double m = robot_.mass;
    const double j = robot_.wheels[0].inertia;
    const double x = robot_.centre_of_gravity_base[0] - robot_.wheels[0].centre_base[0];
    effort = torque;
    const SidePair net{robot_.wheels[0].sign * torque.left - viscous_friction * robot_.wheels[0].sign * speed.left,
                       robot_.wheels[1].sign * torque.right - viscous_friction * robot_.wheels[1].sign * speed.right};
    if (lifted_left) {
      const double acceleration = robot_.wheels[0].sign * net.left / j;
      angle.left += speed.left * dt + 0.5 * acceleration * dt * dt;
      speed.left += acceleration * dt;
      return;
    }
    const double force = (net.left + net.right) / r;
    const double moment = (net.right - net.left) * b / (2 * r);
    const double v_dot =
        (force + m * x * twist.angular * twist.angular - m * kGravity * std::sin(slope)) / (m + 2 * j / (r * r));
    const double w_dot =
        (moment - m * x * twist.linear * twist.angular) / (robot_.yaw_inertia + j * b * b / (2 * r * r));
    move({v_dot, w_dot}, dt);
  }

  /// Idealises the driver's brake law: it damps, and below kBrakeHolds it stands and carries the slope.
  void brake(double dt) {
    const double limit = robot_.joints[robot_.wheels[0].joint].effort_limit;
    if (std::abs(speed.left) < kBrakeHolds && std::abs(speed.right) < kBrakeHolds) {
      const double load = 0.5 * robot_.mass * kGravity * std::sin(slope) * robot_.wheels[0].radius;
      twist = {};
      speed = {};
      effort = {robot_.wheels[0].sign * load, robot_.wheels[1].sign * load};
      return;
    }
    const auto damped = [&](double w) { return std::fmax(-limit, std::fmin(limit, -kBrakeDamping * w)); };
    drive({damped(speed.left), damped(speed.right)}, dt);
  }

 private:
  double quantised(double value) const {
    if (counts <= 0) return value;
    const double count = 2 * std::numbers::pi / counts;
    return std::floor(value / count) * count;
  }

  void move(const PlanarTwist& acceleration, double dt) {
    const double half = 0.5 * robot_.wheel_base;
    const auto rim = [&](const PlanarTwist& t, double side) { return (t.linear + side * half * t.angular); };
    const auto advance = [&](double& q, double& w, const WheelModel& wheel, double side) {
      const double scale = wheel.sign / wheel.radius;
      q += scale * (rim(twist, side) * dt + 0.5 * rim(acceleration, side) * dt * dt);
      w = scale * (rim(twist, side) + rim(acceleration, side) * dt);
    };
    advance(angle.left, speed.left, robot_.wheels[0], -1);
    advance(angle.right, speed.right, robot_.wheels[1], +1);
    distance += twist.linear * dt + 0.5 * acceleration.linear * dt * dt;
    twist = {twist.linear + acceleration.linear * dt, twist.angular + acceleration.angular * dt};
  }

  DriveTrain robot_;
};

}  // namespace robot_control
