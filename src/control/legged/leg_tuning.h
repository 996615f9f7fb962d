#pragma once
/// The values of the leg controller that follow from the robot.
///
/// A robot stands at 0.7 of its leg length. It stands higher, at most at 0.85, where a knee would need more than 0.6 of
/// its torque for half of the weight. A trot puts half of the weight on a leg, at its peak 1.27 times that. So 0.6
/// leaves room for a payload of 20 %, or for a motor that gives 0.8 of its torque. Robots whose knees need more than
/// 0.65 at 0.85 fell or sank (docs/evidence/legs.md).

#include <array>

#include "control/legged/tracked_axis.h"
#include "machine/legs/leg_model.h"
#include "signals/joint.h"

namespace robot_control {

inline constexpr double kLimitShare = 0.9;  ///< of a joint's speed limit; the gate clamps above it

struct LegTuning {
  double stiffness = 0;   ///< N·m/rad, of each joint
  double damping = 0;     ///< N·m·s/rad
  double rise_time = 0;   ///< s, also of lowering; longer where a joint would exceed kLimitShare of its speed limit
  double height = 0;      ///< m, from the feet to the second joints, while standing
  double lift = 0;        ///< m, of a foot in the air
  double sway = 0;        ///< m, range of the body in x and y
  double bob = 0;         ///< m, range of its height
  double lean = 0;        ///< rad, range of roll and pitch together, and of yaw
  double foot_range = 0;  ///< m, of a foot in the air, from above its place
  AxisBounds foot;        ///< m
  AxisBounds joint;       ///< rad, of a joint while the robot lies

  JointCommand impedance(double position, double velocity, double effort) const noexcept {
    return {JointMode::kImpedance, position, velocity, stiffness, damping, effort};
  }
};

LegTuning leg_tuning(const LegModel& robot) noexcept;

/// The knee of a standing robot that needs the largest part of its torque for half of the weight.
struct LoadedKnee {
  std::size_t joint = 0;
  double effort = 0;  ///< N·m
  double part = 0;    ///< of the effort limit
};
LoadedKnee loaded_knee(const LegModel& robot) noexcept;

inline constexpr double kMaxKneePart = 0.65;  ///< of its effort limit, with which a robot walks

/// Returns `value` within ± `range`, and notes if it was beyond.
double within(double value, double range, std::uint64_t& reasons) noexcept;

/// The bounds of a joint while the robot lies.
struct JointBounds {
  JointRange range;   ///< rad; ±∞ where it turns without end
  AxisBounds motion;  ///< rad
};
using AllJointBounds = std::array<JointBounds, kLegsJoints>;
AllJointBounds joint_bounds(const LegModel& robot) noexcept;

}  // namespace robot_control
