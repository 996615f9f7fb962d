#pragma once
/// The measurements of a robot on legs in one cycle: its body, its feet, its command, and whether its joints stand.
/// Joints stand while every one stays within kWindow of its angle for kStandingTime.
///
/// The angle of the body to the vertical has the limit kSteepest, half way to its side. A robot that lies on its body
/// falls from no slope on which it rests: kSteepest is then its limit of tilt, too. A robot on its side or back is
/// still named.
///
///   moving    a joint left its window, or its angle is not known; until the robot stands again
///   standing  all joints are inside for kStandingTime
///
/// In the first kStandingTime of a run the robot is neither.
///
/// A drive that sent nothing leaves its last sample in force, which grows older by the time that passed. Such a sample
/// is not new, and no evidence of what the joint did since.

#include <array>
#include <bitset>
#include <cmath>
#include <cstdint>
#include <limits>

#include "machine/legs/leg_model.h"
#include "safety/conditions/common/body_conditions.h"
#include "safety/conditions/legged/standing_feet.h"

namespace robot_control {

struct LegJointLimits {
  double speed = 0;    ///< rad/s
  double effort = 0;   ///< N·m
  JointRange range{};  ///< rad; ±∞ without end stops
};

struct LeggedMeasurements : BodyMeasurements, FootMeasurements {
  const std::array<LegJointLimits, kLegsJoints>& limits;
  LegPhase phase;  ///< that of the command; lying without one
  std::bitset<kLegsJoints> new_samples;

  bool walks() const noexcept { return phase == LegPhase::kWalking; }
  const JointSample& joint(std::size_t i) const noexcept { return input.sensors->joints[i]; }
  const JointCommand& command(std::size_t i) const noexcept { return input.command->joints[i]; }

  /// The robot walks by a command that holds angles or torques for this joint. A walk gives stiffness to the joints of
  /// feet in the air alone; feet that bear are commanded by torques.
  bool walks_by(std::size_t i) const noexcept { return walks() && command(i).mode == JointMode::kImpedance; }
  /// The joint's foot is in the air.
  bool swings(std::size_t i) const noexcept { return walks_by(i) && command(i).stiffness > 0; }
};

class LeggedObserver {
 public:
  static constexpr double kWindow = 0.01;       ///< rad
  static constexpr double kStandingTime = 0.1;  ///< s
  static constexpr double kForceTime = 0.3;     ///< s, of attitude.h: some steps of a trot
  static constexpr double kLanding = 0.5;       ///< s, of body_motion.h: a fold in a walk, and its blow
  static constexpr double kSteepest = 0.785;    ///< rad, π/4

  /// `period` s.
  LeggedObserver(const SafetyParameters& parameters, const LegModel& robot, double period)
      : period_(period),
        period_ns_(std::llround(1.0e9 * period)),
        body_(robot, {}, period, kForceTime, kLanding),
        feet_(parameters, robot, period) {
    for (std::size_t i = 0; i < kLegsJoints; ++i) {
      const JointModel& joint = robot.joints[i];
      limits_[i] = {.speed = joint.velocity_limit,
                    .effort = joint.effort_limit,
                    .range = joint.range.value_or(JointRange{-kInfinity, kInfinity})};
    }
  }

  static std::size_t driven_joints(const LegModel&) noexcept { return kLegsJoints; }

  void enter_run() noexcept {
    body_.enter_run();
    feet_.enter_run();
    moving_ = anchored_ = false;
    inside_ = 0;
    ages_ns_ = {};
  }

  LeggedMeasurements step(const MonitorInput& input, std::uint64_t elapsed, double /*speed_limit*/) noexcept {
    const SensorFrame& sensors = *input.sensors;
    const double dt = static_cast<double>(elapsed) * period_;
    watch_standstill(sensors, dt);
    body_.step(sensors, elapsed, 0, moving_);
    const LegPhase phase = input.command != nullptr ? input.command->legged.phase : LegPhase::kLying;
    const bool lies = input.command != nullptr && (phase < LegPhase::kRising || phase == LegPhase::kJoints);
    const FootMeasurements feet = feet_.step(input, body_, elapsed);
    const BodyMeasurements body{
        input, elapsed, dt, body_, feet_.ground(), lies ? kSteepest : 0, kSteepest, phase == LegPhase::kWalking};
    return {body, feet, limits_, phase, find_new_samples(sensors, elapsed)};
  }

  bool moving() const noexcept { return moving_; }
  bool standing() const noexcept { return inside_ > kStandingTime; }
  bool sliding() const noexcept { return false; }

 private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

  void watch_standstill(const SensorFrame& sensors, double dt) noexcept {
    if (stays(sensors)) {
      inside_ += dt;
    } else {
      moving_ = moving_ || anchored_;
      inside_ = 0;
      for (std::size_t i = 0; i < kLegsJoints; ++i) anchor_[i] = sensors.joints[i].position;
      anchored_ = true;
    }
    if (standing()) moving_ = false;
  }

  /// The age of a sample that is repeated grows by `elapsed` cycles, but for the jitter of the cycles.
  std::bitset<kLegsJoints> find_new_samples(const SensorFrame& sensors, std::uint64_t elapsed) noexcept {
    std::bitset<kLegsJoints> found;
    const std::int64_t passed_ns = static_cast<std::int64_t>(elapsed) * period_ns_;
    for (std::size_t i = 0; i < kLegsJoints; ++i) {
      const std::int64_t age_ns = sensors.joints[i].age_ns;
      found[i] = age_ns < ages_ns_[i] + passed_ns - period_ns_ / 2;
      ages_ns_[i] = age_ns;
    }
    return found;
  }

  bool stays(const SensorFrame& sensors) const noexcept {
    bool inside = anchored_;
    for (std::size_t i = 0; i < kLegsJoints; ++i) {
      const JointSample& joint = sensors.joints[i];
      inside = inside && has_position(joint) && std::abs(joint.position - anchor_[i]) <= kWindow;
    }
    return inside;
  }

  double period_;
  std::int64_t period_ns_;
  std::array<LegJointLimits, kLegsJoints> limits_{};
  BodyMotion body_;
  StandingFeet feet_;
  std::array<double, kLegsJoints> anchor_{};  ///< rad
  bool anchored_ = false;
  bool moving_ = false;
  double inside_ = 0;                                ///< s
  std::array<std::int64_t, kLegsJoints> ages_ns_{};  ///< of the samples in the cycle before
};

}  // namespace robot_control
