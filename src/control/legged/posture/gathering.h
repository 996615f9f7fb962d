#pragma once
/// Moves the joints of a robot that lies from where they are to the lying posture, and measures the ground's slope
/// there. On a slope that is too steep the robot does not stand up (ground_slope.h).

#include <algorithm>
#include <cmath>

#include "control/legged/leg_tuning.h"
#include "control/legged/posture/ground_slope.h"
#include "machine/legs/leg_model.h"
#include "signals/legged/legged_command.h"
#include "signals/state_frame.h"

namespace robot_control {

class Gathering {
 public:
  static constexpr double kMinTime = 0.1;  ///< s

  struct State {
    LegsValues from{};  ///< rad, joint angles at the beginning
  };

  explicit Gathering(const LegModel& robot) : bounds_(joint_bounds(robot)), lying_pitch_(robot.lying_pitch) {
    for (std::size_t leg = 0; leg < kLegs; ++leg) LegAngles::Map(&lying_[kLegJoints * leg]) = robot.legs[leg].lying;
  }

  /// Sets the joint angles of `elapsed` s after the beginning. Returns true at the end.
  bool step(const State& state, double elapsed, LegsValues& angles) const noexcept {
    double time = kMinTime;
    for (std::size_t i = 0; i < kLegsJoints; ++i)  // the smooth way is 1.5 times as fast in its middle
      time = std::max(time, 1.5 * std::abs(lying_[i] - state.from[i]) / bounds_[i].motion.speed);
    const double part = smooth_step(elapsed / time);
    for (std::size_t i = 0; i < kLegsJoints; ++i) angles[i] = state.from[i] + part * (lying_[i] - state.from[i]);
    return elapsed >= time;
  }

  /// Sets the vertical in the axes of the ground, which counts as level without a valid estimate. Returns false, and
  /// notes it, where the ground is too steep.
  bool stands_up_here(const StateFrame* estimate, Vector3& up, std::uint64_t& reasons) const noexcept {
    up = {0, 0, 1};
    if (estimate == nullptr || (estimate->base.flags & kStateValid) == 0) return true;
    const Eigen::Vector3d measured = vertical_over_ground(estimate->base.attitude, lying_pitch_);
    if (measured.z() < std::cos(kLevelSlope)) up = {measured.x(), measured.y(), measured.z()};
    const bool steep = measured.z() < std::cos(kMaxSlope);
    if (steep) reasons |= kReasonTooSteep;
    return !steep;
  }

 private:
  AllJointBounds bounds_;
  LegsValues lying_{};  ///< rad
  double lying_pitch_;  ///< rad
};

}  // namespace robot_control
