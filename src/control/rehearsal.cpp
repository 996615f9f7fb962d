#include "control/rehearsal.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "control/drive_controller.h"
#include "control/kinematics.h"
#include "control/limits/drive_limits.h"
#include "control/wheel_loops/ground_friction.h"
#include "control/wheel_loops/quantisation_ripple.h"
#include "robot/gravity.h"

namespace robot_control {
namespace {

constexpr double kRehearsedFriction = 0.1;  // rad/s, ε of feed_forward.h
constexpr double kSteady = 0.5;             // s after a ramp
constexpr double kLongestRamp = 10.0;       // s
constexpr double kPush = 0.01;              // of the weight: rolling resistance of a hard wheel, a caster that swivels
constexpr double kLostGrip = 0.05;          // of treads that scrub: what scrub.h misses of a curve, or a floor's seam
constexpr double kCount = 2 * std::numbers::pi / kCounts;  // rad
constexpr double kStretch = 5;                             // the longest that a ramp is stretched where torque is short

/// The robot of the header.
class RigidRobot {
 public:
  explicit RigidRobot(const RobotModel& robot) : robot_(robot), kinematics_(robot), scrub_(robot) {
    double middle = 0;
    double count = 0;
    for (const WheelModel& wheel : robot.wheels) {
      middle += wheel.centre_base[0];
      inertia_ += wheel.inertia;
      radius_ += wheel.radius;
      ++count;
    }
    inertia_ /= count;
    radius_ /= count;
    beside_ = count / 2;
    centre_ahead_ = robot.centre_of_gravity_base[0] - middle / count;
  }

  const PlanarTwist& twist() const noexcept { return twist_; }

  /// Over one period with the torques of `command`, and the force `push`, N, forwards at the right wheels; treads grip
  /// with the part `grip` of their friction.
  void step(const CommandFrame& command, double push, double grip, double dt) noexcept {
    if (command.joints[0].mode == JointMode::kBrake) {
      twist_ = {};
      effort_ = {};
      strain_ = {};
      return;
    }
    const WheelValues speed = kinematics_.joint_speeds(twist_);
    SidePair torque{0, push * radius_ / beside_};
    double damping = 0;  // N·m·s/rad, of all joints alike
    for (std::size_t i = 0; i < robot_.wheels.size(); ++i) {
      const WheelModel& wheel = robot_.wheels[i];
      const JointModel& joint = robot_.joints[wheel.joint];
      effort_[i] = std::clamp(command.joints[i].effort, -joint.effort_limit, joint.effort_limit);
      const bool left = wheel.side == Side::kLeft;
      (left ? torque.left : torque.right) += wheel.sign * effort_[i] / beside_;
      const double turning = std::max(std::abs(speed[i]), 1e-9);
      damping += joint.damping + joint.friction * std::tanh(turning / kRehearsedFriction) / turning;
    }
    damping /= static_cast<double>(robot_.wheels.size());
    const double turning = std::copysign(std::max(std::abs(twist_.angular), 1e-9), twist_.angular);
    // Treads as springs of the turn in this step, from what they would hold without it.
    WheelValues kept = strain_, turned_on = strain_;
    scrub_.strain(kept, twist_.linear, 0, dt);
    scrub_.strain(turned_on, twist_.linear, turning, dt);
    const double held = grip * scrub(kept);
    const double scrubbing = (grip * scrub(turned_on) - held) / turning;  // N·m·s/rad
    const double base = robot_.wheel_base;
    const double rim = 0.5 * robot_.effective_wheel_base();
    const double lever = radius_ / beside_;
    const double pull = 0.5 * (torque.right + torque.left) +
                        0.5 * lever * robot_.mass * centre_ahead_ * twist_.angular * twist_.angular;
    const double turn = 0.5 * (torque.right - torque.left) -
                        lever * robot_.mass * centre_ahead_ * twist_.linear * twist_.angular / base - held;
    const double linear_inertia = 0.5 * lever * robot_.mass + inertia_ / radius_;
    const double angular_inertia = lever * robot_.yaw_inertia / base + inertia_ * rim / radius_;
    // Losses implicitly: they may be stiff against the period.
    const PlanarTwist next{
        (twist_.linear + dt * pull / linear_inertia) / (1 + dt * damping / (radius_ * linear_inertia)),
        (twist_.angular + dt * turn / angular_inertia) /
            (1 + dt * (damping * rim / radius_ + scrubbing) / angular_inertia)};
    const WheelValues turned =
        kinematics_.joint_speeds({0.5 * (twist_.linear + next.linear), 0.5 * (twist_.angular + next.angular)});
    for (std::size_t i = 0; i < robot_.wheels.size(); ++i) angle_[i] += turned[i] * dt;
    scrub_.strain(strain_, twist_.linear, next.angular, dt);
    twist_ = next;
  }

  void sample(SensorFrame& sensors) const noexcept {
    const WheelValues speed = kinematics_.joint_speeds(twist_);
    for (std::size_t i = 0; i < robot_.wheels.size(); ++i) {
      sensors.joints[i] = {
          .position = std::round(angle_[i] / kCount) * kCount, .velocity = speed[i], .effort = effort_[i]};
    }
  }

 private:
  /// N·m against a turn to the left, mean of the wheels.
  double scrub(const WheelValues& strain) const noexcept {
    double sum = 0;
    for (std::size_t i = 0; i < robot_.wheels.size(); ++i) {
      const WheelModel& wheel = robot_.wheels[i];
      sum += wheel.side == Side::kLeft ? -wheel.sign * strain[i] : wheel.sign * strain[i];
    }
    return kGroundFriction * sum / static_cast<double>(robot_.wheels.size());
  }

  const RobotModel& robot_;
  DriveKinematics kinematics_;
  Scrub scrub_;
  double inertia_ = 0;  // kg·m², mean of the wheels'
  double radius_ = 0;   // m
  double beside_ = 1;   // h
  double centre_ahead_ = 0;
  PlanarTwist twist_;
  WheelValues angle_{};
  WheelValues effort_{};
  WheelValues strain_{};  ///< N·m, z of scrub.h
};

double ramp_time(double speed, const MotionLimits& limits) noexcept {
  const double slowest = std::min(limits.acceleration, limits.deceleration);
  return std::abs(speed) / slowest + slowest / limits.jerk;
}

/// By how much a speed is beyond its ramp, all of kExcessTime.
class ExcessWatch {
 public:
  /// `tolerance` towards more speed, `back` beyond rest, both in the unit of `speed`.
  ExcessWatch(double speed, double tolerance, double back, double period)
      : speed_(speed),
        tolerance_(tolerance),
        back_(back),
        last_(std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(kExcessTime / period))), 0.0) {}

  /// In tolerances.
  double step(double value) noexcept {
    const double along = speed_ < 0 ? -value : value;
    const double beyond = std::max((along - std::abs(speed_)) / tolerance_, -along / back_);
    last_[next_] = std::isfinite(beyond) ? beyond : std::numeric_limits<double>::infinity();
    next_ = (next_ + 1) % last_.size();
    return *std::ranges::min_element(last_);
  }

 private:
  double speed_;
  double tolerance_;
  double back_;
  std::vector<double> last_;
  std::size_t next_ = 0;
};

class Rehearsal {
 public:
  Rehearsal(const DriveControllerParameters& parameters, const RobotModel& described, const RobotModel& plant,
            double period)
      : limits_(speed_limits(parameters)),
        described_(described),
        plant_(plant),
        period_(period),
        kinematics_(described),
        controller_(parameters, described, period) {}

  /// Adds the excesses of this motion, `pushed` or not.
  void drive(const PlanarTwist& motion, bool pushed, std::vector<Excess>& out) {
    const double scale = kinematics_.wheel_speed_scale(motion);  // the controller asks for no more
    const PlanarTwist asked{scale * motion.linear, scale * motion.angular};
    controller_.enter_run();
    RigidRobot robot(plant_);
    SensorFrame sensors;
    sensors.valid = kValidJoints;
    sensors.joint_count = described_.joints.size();
    Permit permit;
    permit.action = PermitAction::kDrive;
    permit.speed_limit = kNoSpeedLimit;
    VelocityCommand request;
    CommandFrame last;
    CommandFrame command;
    const double ramp = std::min(
        kLongestRamp, std::max(ramp_time(asked.linear, limits_.linear), ramp_time(asked.angular, limits_.angular)));
    const auto half = static_cast<std::uint64_t>((kSteady + stretched(ramp)) / period_);
    const double rim = 0.5 * described_.effective_wheel_base();
    const double fastest = std::abs(asked.linear) + rim * std::abs(asked.angular);
    const auto watch = [&](double speed, double in_rim) {  // in_rim: m of rim per unit of speed
      const double part = kExcessPart * (speed != 0 ? std::abs(speed) * in_rim : fastest);
      return ExcessWatch(speed, std::max(part, kLeastExcess) / in_rim, std::max(part, kLeastReverse) / in_rim, period_);
    };
    ExcessWatch linear = watch(asked.linear, 1);
    ExcessWatch angular = watch(asked.angular, rim);
    std::array<Excess, 4> excesses;
    for (std::size_t i = 0; i < excesses.size(); ++i)
      excesses[i] = {.motion = asked, .turning = i >= 2, .stopping = i % 2 == 1};
    const auto push_cycles = static_cast<std::uint64_t>(kSteady / period_);
    const double push = pushed ? kPush * kGravity * plant_.mass : 0;
    for (std::uint64_t cycle = 0; cycle < 2 * half; ++cycle) {
      const bool stopping = cycle >= half;
      sensors.head.cycle = permit.head.cycle = cycle;
      robot.sample(sensors);
      const bool moving = cycle > 1 && !stopping;
      request.twist.linear[0] = moving ? asked.linear : 0;
      request.twist.angular[2] = moving ? asked.angular : 0;
      ++request.count;  // in every cycle, so that none times out
      controller_.step({.sensors = &sensors, .permit = &permit, .request = request}, command);
      const bool steady = cycle + push_cycles >= half && !stopping;
      robot.step(last, steady ? push : 0, steady && pushed ? 1 - kLostGrip : 1, period_);
      sensors.gate.verdict = last.joints[0].mode == JointMode::kBrake ? GateVerdict::kBrake : GateVerdict::kPassed;
      last = command;
      note(linear.step(robot.twist().linear), robot.twist().linear, excesses[stopping ? 1 : 0]);
      note(angular.step(robot.twist().angular), robot.twist().angular, excesses[stopping ? 3 : 2]);
    }
    out.insert(out.end(), excesses.begin(), excesses.end());
  }

 private:
  static void note(double times, double reached, Excess& worst) noexcept {
    if (times <= worst.times) return;
    worst.times = times;
    worst.reached = reached;
  }

  /// A ramp whose torque the motors do not have is stretched by the controller.
  double stretched(double ramp) const noexcept { return std::min(kLongestRamp, std::min(kStretch * ramp, ramp + 1)); }

  SpeedLimits limits_;
  const RobotModel& described_;
  const RobotModel& plant_;
  double period_;
  DriveKinematics kinematics_;
  DriveController controller_;
};

}  // namespace

std::vector<Excess> rehearse(const DriveControllerParameters& parameters, const RobotModel& described,
                             const RobotModel& plant, double period) {
  Rehearsal rehearsal(parameters, described, plant, period);
  const double linear = parameters.max_linear_speed;
  const double angular = parameters.max_angular_speed;
  std::vector<Excess> excesses;
  rehearsal.drive({linear, 0}, true, excesses);
  rehearsal.drive({0, angular}, true, excesses);
  rehearsal.drive({0.5 * linear, 0.5 * angular}, false, excesses);
  for (const double part : kSlowerParts) {
    rehearsal.drive({part * linear, 0}, false, excesses);
    rehearsal.drive({0, part * angular}, false, excesses);
  }
  return excesses;
}

}  // namespace robot_control
