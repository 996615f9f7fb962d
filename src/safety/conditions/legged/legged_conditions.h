#pragma once
/// The conditions of a robot on legs compare body, joints and feet with their limits (body_conditions.h,
/// downward_force.h, joint_conditions.h, encoder_conditions.h, foot_conditions.h). They also compare the state with the
/// gyro (wrong_state.h), and tell whether the joints stand. Joints stand while every one stays within kWindow of its
/// angle for kStandingTime.
///
/// A robot that lies on its body falls from no slope on which it rests. Its limit of tilt is then at least kLyingTilt,
/// half way to its side. A robot on its side or back is still named.
///
///   moving    a joint left its window, or its angle is not known; until the robot stands again
///   standing  all joints are inside for kStandingTime
///
/// In the first kStandingTime of a run the robot is neither.

#include <array>
#include <cmath>

#include "machine/legs/leg_model.h"
#include "safety/conditions/common/body_conditions.h"
#include "safety/conditions/legged/downward_force.h"
#include "safety/conditions/legged/encoder_conditions.h"
#include "safety/conditions/legged/foot_conditions.h"
#include "safety/conditions/legged/joint_conditions.h"
#include "safety/conditions/legged/wrong_state.h"
#include "safety/latch/active_causes.h"
#include "safety/monitor_input.h"
#include "safety/safety_parameters.h"

namespace robot_control {

class LeggedConditions {
 public:
  static constexpr double kWindow = 0.01;       ///< rad
  static constexpr double kStandingTime = 0.1;  ///< s
  static constexpr double kForceTime = 0.3;     ///< s, of attitude.h: some steps of a trot
  static constexpr double kLanding = 0.5;       ///< s, of body_conditions.h: a fold in a walk, and its blow
  static constexpr double kLyingTilt = 0.785;   ///< rad, π/4

  /// `period` s.
  LeggedConditions(const SafetyParameters& parameters, const LegModel& robot, double period)
      : period_(period),
        body_conditions_(parameters, robot, {}, period, kForceTime, kLanding),
        downward_force_(parameters, period),
        wrong_state_(parameters, period),
        joint_conditions_(parameters, robot, period),
        encoder_conditions_(parameters, robot, period),
        foot_conditions_(parameters, robot, period) {}

  static std::size_t driven_joints(const LegModel&) noexcept { return kLegsJoints; }

  void enter_run() noexcept {
    body_conditions_.enter_run();
    downward_force_.enter_run();
    wrong_state_.enter_run();
    joint_conditions_.enter_run();
    encoder_conditions_.enter_run();
    foot_conditions_.enter_run();
    moving_ = anchored_ = false;
    inside_ = 0;
  }

  void step(const MonitorInput& input, std::uint64_t elapsed, double /*speed_limit*/, ActiveCauses& out) noexcept {
    const SensorFrame& sensors = *input.sensors;
    if (stays(sensors)) {
      inside_ += static_cast<double>(elapsed) * period_;
    } else {
      moving_ = moving_ || anchored_;
      inside_ = 0;
      for (std::size_t i = 0; i < kLegsJoints; ++i) anchor_[i] = sensors.joints[i].position;
      anchored_ = true;
    }
    if (standing()) moving_ = false;
    const LegPhase phase = input.command != nullptr ? input.command->legged.phase : LegPhase::kLying;
    const bool lies = input.command != nullptr && (phase < LegPhase::kRising || phase == LegPhase::kJoints);
    body_conditions_.step(sensors, elapsed, 0, moving_, out, lies ? kLyingTilt : 0);
    downward_force_.step(body_conditions_.along_z(), phase, elapsed, out);
    wrong_state_.step(input.state, body_conditions_.rate(), elapsed, out);
    joint_conditions_.step(input, elapsed, out);
    encoder_conditions_.step(input, elapsed, out);
    foot_conditions_.step(input, body_conditions_.attitude().up(), body_conditions_.rate(), elapsed, out);
  }

  bool moving() const noexcept { return moving_; }
  bool standing() const noexcept { return inside_ > kStandingTime; }
  bool sliding() const noexcept { return false; }

 private:
  bool stays(const SensorFrame& sensors) const noexcept {
    bool inside = anchored_;
    for (std::size_t i = 0; i < kLegsJoints; ++i) {
      const JointSample& joint = sensors.joints[i];
      inside = inside && has_position(joint) && std::abs(joint.position - anchor_[i]) <= kWindow;
    }
    return inside;
  }

  double period_;
  BodyConditions body_conditions_;
  DownwardForce downward_force_;
  WrongState wrong_state_;
  JointConditions joint_conditions_;
  EncoderConditions encoder_conditions_;
  FootConditions foot_conditions_;
  LegsValues anchor_{};  ///< rad
  bool anchored_ = false;
  bool moving_ = false;
  double inside_ = 0;  ///< s
};

}  // namespace robot_control
