#pragma once
/// The conditions of a robot on wheels: how its wheels and its body move, compared with limits and targets.
///
///   wheel_motion.h ─► wheel_limits.h, wheel_following.h, torque_oscillation.h, yaw_agreement.h, joint_standstill.h,
///                     slide.h, rim_speed.h ─► body_conditions.h
///
/// Limits that are left out are not evaluated: call derived_limits (derived_limits.h) first.

#include "machine/wheeled/drive_train.h"
#include "safety/conditions/common/body_conditions.h"
#include "safety/conditions/wheeled/torque_oscillation.h"
#include "safety/conditions/wheeled/wheel_following.h"
#include "safety/conditions/wheeled/wheel_limits.h"
#include "safety/conditions/wheeled/yaw_agreement.h"
#include "safety/latch/active_causes.h"
#include "safety/measurements/joint_standstill.h"
#include "safety/measurements/rim_speed.h"
#include "safety/measurements/slide.h"
#include "safety/measurements/wheel_motion.h"
#include "safety/measurements/wheel_targets.h"
#include "safety/monitor_input.h"
#include "safety/safety_parameters.h"

namespace robot_control {

class WheeledConditions {
 public:
  /// `period` s.
  WheeledConditions(const SafetyParameters& parameters, const DriveTrain& robot, double period);

  static std::size_t driven_joints(const DriveTrain& robot) noexcept { return robot.wheels.size(); }

  void enter_run() noexcept;
  void step(const MonitorInput& input, std::uint64_t elapsed, double speed_limit, ActiveCauses& out) noexcept;

  bool moving() const noexcept { return standstill_.moving(); }
  bool standing() const noexcept { return standstill_.standing(); }
  bool sliding() const noexcept { return standstill_.standing() && slide_.possible(); }

 private:
  WheelMotion motion_;
  JointStandstill standstill_;
  Slide slide_;
  WheelTargets targets_;
  WheelLimits wheel_limits_;
  WheelFollowing wheel_following_;
  TorqueOscillation torque_oscillation_;
  YawAgreement yaw_agreement_;
  RimSpeed rim_speed_;
  BodyConditions body_conditions_;
};

}  // namespace robot_control
