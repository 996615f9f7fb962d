#pragma once
/// VelocityDrive is the law of a simulated drive that closes the loop of its own speed and measures no torque.
///
///   kDriveVelocity   q̇* = velocity, as a multiple of `resolution`; 0 if it is below `dead_band`
///   kBrake, unknown modes, numbers that are not finite   q̇* = 0, and at rest what `at_rest` says
///
///   e = q̇* − q̇,   τ = P e + ∫ I e dt + τ_ff,   |τ| ≤ the effort limit, or that of the brake
///
/// τ_ff is the command's effort if the drive takes one and does not brake, else 0.
///
/// The integral stands while the torque is at its limit towards e. The limit of the brake is its effort, and its hold
/// effort from where a BrakeLaw begins to hold. At rest, |q̇| below the hold speed of the brake, a drive that releases
/// gives no torque until the next velocity.
///
/// A drive is tuned for the robot that it carries. With M, the inertia of a wheel when driving straight, and J, that of
/// the lifted wheel:
///
///   P = gain · min(M/T, 0.4 J/h)     I = P/(4 T)     T = 20 ms
///
/// h is the simulation's step. `gain` is the user's deviation from this.

#include <algorithm>
#include <cmath>

#include "drivers/drive_brake.h"
#include "gate/brake_law.h"
#include "signals/joint.h"

namespace robot_control {

struct VelocityDriveParameters {
  double loaded_inertia = 0;  ///< kg·m², M
  double lifted_inertia = 0;  ///< kg·m², J
  double effort_limit = 0;    ///< N·m
  double gain = 1;
  bool takes_feed_forward = true;
  double dead_band = 0;   ///< rad/s
  double resolution = 0;  ///< rad/s; 0: exact
  DriveBrake at_rest = DriveBrake::kHold;
  Brake brake;  ///< its torques and its hold speed
};

class VelocityDrive {
 public:
  /// `step` is h in s.
  VelocityDrive(const VelocityDriveParameters& parameters, double step) noexcept
      : parameters_(parameters),
        proportional_(parameters.gain *
                      std::min(parameters.loaded_inertia / kResponse, 0.4 * parameters.lifted_inertia / step)),
        integral_gain_(proportional_ / (4 * kResponse)),
        step_(step),
        brake_(parameters.brake) {}

  void reset() noexcept {
    integral_ = 0;
    released_ = false;
    brake_.release();
  }

  /// Returns τ in N·m for the next time step.
  double step(const JointCommand& command, double velocity) noexcept {
    const bool drives = command.mode == JointMode::kDriveVelocity && finite(command);
    const bool rests = std::abs(velocity) <= parameters_.brake.hold_speed;
    released_ = !drives && parameters_.at_rest == DriveBrake::kRelease && (released_ || rests);
    if (released_) return integral_ = 0;
    if (drives) {
      brake_.release();
    } else {
      brake_.step(0, 0, velocity);  // When it holds depends on the speed alone.
    }
    const double braking = brake_.holding() ? parameters_.brake.hold_effort : parameters_.brake.effort;
    const double limit = drives ? parameters_.effort_limit : std::min(braking, parameters_.effort_limit);
    const double error = (drives ? taken(command.velocity) : 0) - velocity;
    const double feed_forward = drives && parameters_.takes_feed_forward ? command.effort : 0;
    const double wanted = proportional_ * error + integral_ + feed_forward;
    const double effort = std::clamp(wanted, -limit, limit);
    if ((wanted - effort) * error <= 0)
      integral_ = std::clamp(integral_ + integral_gain_ * error * step_, -limit, limit);
    return effort;
  }

 private:
  static constexpr double kResponse = 0.02;  ///< s, T

  double taken(double velocity) const noexcept {
    if (parameters_.resolution > 0) velocity = std::round(velocity / parameters_.resolution) * parameters_.resolution;
    return std::abs(velocity) < parameters_.dead_band ? 0 : velocity;
  }

  VelocityDriveParameters parameters_;
  double proportional_;   ///< N·m·s/rad
  double integral_gain_;  ///< N·m/rad
  double step_;           ///< s
  double integral_ = 0;   ///< N·m
  bool released_ = false;
  BrakeLaw brake_;
};

}  // namespace robot_control
