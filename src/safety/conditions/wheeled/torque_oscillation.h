#pragma once
/// This condition finds a motor torque that oscillates although the planned motion does not require it.
///
///   ripple     τ minus its low pass of kCutoff; RMS over kWindow. The smaller of the ripples of measured and commanded
///              torque: a command that the gate clamps, and ripple that the motor adds, do not count
///   explained  J·α*, α* the planned acceleration of the wheel's target, filtered in the same way. J: inertia of the
///              loaded wheel, the larger of driving straight and turning (drive_train.h, robot as described)
///   counted    SafetyParameters::count_ripple · quantum (wheel_motion.h): the torque that derived gains produce from
///              encoder quantisation. With few counts per turn it exceeds the motor's torque, and the condition cannot
///              be active
///
///   torque_oscillation   ripple > limit·τ_max + 2·explained + counted,   of the worst wheel, as a part of τ_max
///
/// Alternation between both torque limits has a ripple of τ_max; over bumps it is 0.3 τ_max for a moment. A latching
/// reaction is preceded by a warning after kWarned of its persistence. Only wheels with a target (wheel_targets.h) are
/// evaluated: the torque of the brake is the driver's own.

#include <array>
#include <cstddef>

#include "safety/conditions/common/condition_list.h"
#include "safety/conditions/wheeled/wheeled_observer.h"

namespace robot_control {

class TorqueOscillation {
 public:
  static constexpr double kCutoff = 5.0;  ///< Hz; torque for driving is slower, oscillation is faster
  static constexpr double kWindow = 0.5;  ///< s
  static constexpr double kWarned = 0.5;

  /// `period` s.
  TorqueOscillation(const SafetyParameters& parameters, const DriveTrain& robot, double period) noexcept;

  void enter_run() noexcept;
  void step(const WheeledMeasurements& now, ActiveCauses& out) noexcept;

 private:
  /// The parts of the two low passes' states that a step replaces, 1 − e^{−dt/T}.
  struct Weights {
    double slow;    ///< low pass of kCutoff
    double window;  ///< mean over kWindow
  };
  /// RMS of the part that is faster than kCutoff.
  struct Ripple {
    double slow = 0;
    double square = 0;
    void step(double value, const Weights& weights) noexcept;
    double rms() const noexcept;
  };
  struct Wheel {
    bool driven = false;  ///< in the last cycle
    double target = 0;    ///< rad/s, of the last cycle
    Ripple measured;
    Ripple commanded;
    Ripple planned;
  };

  static Weights weights_of(double dt) noexcept;
  void follow(std::size_t wheel, double measured, double commanded, double target, double dt) noexcept;
  ConditionMeasurement measure(std::size_t wheel, const WheeledMeasurements& now) const noexcept;

  double period_;      ///< s
  Weights one_cycle_;  ///< weights of a period
  ConditionWatch warning_;
  ConditionWatch watch_;
  std::array<Wheel, kMaxWheels> wheels_{};
  std::array<double, kMaxWheels> commanded_{};     ///< N·m, last seen
  std::array<double, kMaxWheels> inertia_{};       ///< kg·m², J
  std::array<double, kMaxWheels> count_ripple_{};  ///< N·m/rad
};

}  // namespace robot_control
