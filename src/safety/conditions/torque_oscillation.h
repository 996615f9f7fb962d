#pragma once
/// Does a motor pull to and fro, for nothing that the motion asks of it?
///
///   ripple     τ minus its low pass of kSlow; RMS over kWindow. Of the torque that was measured and of that which was
///              commanded, the smaller: what the gate cuts off is its own doing, and so is what a motor makes of it
///   explained  J·α*, of the planned acceleration α* of the wheel's target, in the same way; J: of the loaded wheel,
///              the larger of driving straight and turning (control/wheel_loops/feed_forward.h, of the robot as
///              described)
///   counted    SafetyParameters::count_ripple · quantum (wheel_motion.h): what derived gains make of the encoder's
///              counts. With few counts a turn it is more than the motor has; then nothing is beyond
///
///   torque_oscillation   ripple > limit·τ_max + 2·explained + counted,   of the worst wheel, in parts of τ_max
///
/// Alternating between both torque limits the ripple is τ_max; over bumps it is 0.3 τ_max for a moment. A latching
/// reaction is announced by a warning after kWarned of its persistence. Only wheels that a target reaches
/// (wheel_targets.h) are judged: the brake's torque is the driver's own.

#include <array>
#include <cstddef>
#include <cstdint>

#include "robot/robot_model.h"
#include "safety/latch/active_causes.h"
#include "safety/measurements/wheel_motion.h"
#include "safety/measurements/wheel_targets.h"
#include "safety/monitor_input.h"

namespace robot_control {

class TorqueOscillation {
 public:
  static constexpr double kSlow = 5.0;    ///< Hz; what drives a robot is slower, what shakes it is faster
  static constexpr double kWindow = 0.5;  ///< s
  static constexpr double kWarned = 0.5;

  /// `period` s.
  TorqueOscillation(const SafetyParameters& parameters, const RobotModel& robot, double period) noexcept;

  void enter_run() noexcept;
  void step(const MonitorInput& input, const WheelTargets& targets, const WheelMotion& motion, std::uint64_t elapsed,
            ActiveCauses& out) noexcept;

 private:
  /// RMS of what is faster than kSlow.
  struct Ripple {
    double slow = 0;
    double square = 0;
    void step(double value, double forgets_slow, double forgets) noexcept;
    double rms() const noexcept;
  };
  struct Wheel {
    bool driven = false;  ///< in the last cycle
    double target = 0;    ///< rad/s, of the last cycle
    Ripple measured;
    Ripple commanded;
    Ripple planned;
  };

  void follow(std::size_t wheel, double measured, double commanded, double target, std::uint64_t elapsed) noexcept;
  Finding judge(std::size_t wheel, const WheelMotion& motion) const noexcept;

  double period_;
  ConditionWatch warning_;
  ConditionWatch watch_;
  std::size_t count_;
  std::array<Wheel, kMaxWheels> wheels_{};
  std::array<double, kMaxWheels> commanded_{};     ///< N·m, last seen
  std::array<double, kMaxWheels> effort_limit_{};  ///< N·m
  std::array<double, kMaxWheels> inertia_{};       ///< kg·m², J
  std::array<double, kMaxWheels> count_ripple_{};  ///< N·m/rad
};

}  // namespace robot_control
