#pragma once
/// The measurements of a robot on wheels in one cycle: the motion of its wheels and its body, and their targets.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "machine/wheeled/drive_train.h"
#include "safety/conditions/common/body_conditions.h"
#include "safety/measurements/joint_standstill.h"
#include "safety/measurements/slide.h"
#include "safety/measurements/wheel_motion.h"
#include "safety/measurements/wheel_targets.h"
#include "safety/measurements/yaw_agreement.h"
#include "signals/permit.h"
#include "signals/sensor_frame.h"

namespace robot_control {

/// The largest speed limit of the last ramp_time to 2·ramp_time: every limit below it has been in force for long
/// enough.
class SpeedLimitInForce {
 public:
  SpeedLimitInForce(double ramp_time, double period) noexcept
      : cycles_(static_cast<std::uint64_t>(std::llround(ramp_time / period))) {}

  void enter_run() noexcept {
    since_ = 0;
    last_ = now_ = kNoSpeedLimit;
  }

  /// m/s
  double step(double speed_limit, std::uint64_t elapsed) noexcept {
    now_ = std::max(now_, speed_limit);
    since_ += elapsed;
    if (since_ >= cycles_) {
      since_ = 0;
      last_ = now_;
      now_ = speed_limit;
    }
    return std::max(last_, now_);
  }

 private:
  std::uint64_t cycles_;
  std::uint64_t since_ = 0;
  double last_ = kNoSpeedLimit;  ///< the largest of the last full ramp_time
  double now_ = kNoSpeedLimit;   ///< the largest since then
};

/// The speed of the robot along its x axis, as the mean rim speed of its drive wheels. It belongs to the point in the
/// middle of the axles. It is the drives' own velocity, so it needs no samples of earlier cycles.
class RimSpeed {
 public:
  explicit RimSpeed(const DriveTrain& robot) noexcept : count_(std::min(robot.wheels.size(), kMaxWheels)) {
    for (std::size_t i = 0; i < count_; ++i) rim_per_joint_[i] = robot.wheels[i].sign * robot.wheels[i].radius;
  }

  /// Returns the speed in m/s; 0 while the joint samples are not valid or not finite.
  double value(const SensorFrame& sensors) const noexcept {
    if (count_ == 0 || !joints_have(sensors, count_, kValidVelocity)) return 0;
    double sum = 0;
    for (std::size_t i = 0; i < count_; ++i) sum += rim_per_joint_[i] * sensors.joints[i].velocity;
    return std::isfinite(sum) ? sum / static_cast<double>(count_) : 0;
  }

 private:
  std::size_t count_;
  std::array<double, kMaxWheels> rim_per_joint_{};  ///< m/s per rad/s, forwards
};

struct WheelNumbers {
  double radius = 0;        ///< m
  double effort_limit = 0;  ///< N·m; ∞ without one
};

struct WheeledMeasurements : BodyMeasurements {
  const std::array<WheelNumbers, kMaxWheels>& wheels;
  const WheelMotion& motion;
  const JointStandstill& standstill;
  const WheelTargets& targets;
  bool efforts_measured;          ///< of all wheels
  double speed_limit;             ///< m/s, in force for long enough
  ConditionMeasurement yaw_rate;  ///< of gyro and wheels (yaw_agreement.h)
};

class WheeledObserver {
 public:
  /// `period` s.
  WheeledObserver(const SafetyParameters& parameters, const DriveTrain& robot, double period)
      : period_(period),
        motion_(robot.wheels.size(), period),
        standstill_(parameters.standstill_speed, period),
        slide_(parameters, robot, period),
        targets_(robot.wheels.size()),
        in_force_(parameters.ramp_time, period),
        yaw_agreement_(parameters, robot),
        rim_speed_(robot),
        body_(robot, middle_of_axles(robot), period) {
    for (std::size_t i = 0; i < std::min(robot.wheels.size(), kMaxWheels); ++i) {
      const double effort = robot.joints[robot.wheels[i].joint].effort_limit;
      wheels_[i] = {robot.wheels[i].radius, effort > 0 ? effort : std::numeric_limits<double>::infinity()};
    }
  }

  static std::size_t driven_joints(const DriveTrain& robot) noexcept { return robot.wheels.size(); }

  void enter_run() noexcept {
    motion_.enter_run();
    standstill_.enter_run();
    slide_.enter_run();
    targets_.enter_run();
    in_force_.enter_run();
    body_.enter_run();
  }

  WheeledMeasurements step(const MonitorInput& input, std::uint64_t elapsed, double speed_limit) noexcept {
    const SensorFrame& sensors = *input.sensors;
    motion_.step(sensors);
    standstill_.step(motion_, sensors.head.cycle);
    slide_.step(motion_, standstill_.standing(), elapsed);
    targets_.step(input);
    body_.step(sensors, elapsed, rim_speed_.value(sensors), standstill_.moving());
    const BodyMeasurements body{input, elapsed, static_cast<double>(elapsed) * period_, body_,
                                body_.attitude().vertical()};
    const bool efforts_measured = joints_have(sensors, motion_.wheels(), kValidEffort);
    const double in_force = in_force_.step(speed_limit, elapsed);
    return {body,     wheels_,          motion_,  standstill_,
            targets_, efforts_measured, in_force, yaw_agreement_.measure(sensors, motion_)};
  }

  bool moving() const noexcept { return standstill_.moving(); }
  bool standing() const noexcept { return standstill_.standing(); }
  bool sliding() const noexcept { return standstill_.standing() && slide_.possible(); }

 private:
  double period_;
  std::array<WheelNumbers, kMaxWheels> wheels_{};
  WheelMotion motion_;
  JointStandstill standstill_;
  Slide slide_;
  WheelTargets targets_;
  SpeedLimitInForce in_force_;
  YawAgreement yaw_agreement_;
  RimSpeed rim_speed_;
  BodyMotion body_;
};

}  // namespace robot_control
