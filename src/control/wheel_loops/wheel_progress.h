#pragma once
/// Does a wheel turn as planned at all? By its encoder alone, no model.
///
/// ω̄*, ω̄: first-order means, with time constant T, of the planned speed and of the speed of the measured angle
///
///   held = sign(ω̄*)·clamp(1 − ω̄/(kTurns·ω̄*), 0, 1)       T = max(30 ms, 1/kTurns · quantum/|planned speed|)
///
/// so that a wheel at kTurns of its plan turns by a count within T. 1: it stands, or turns the other way. With each
/// change of the plan's sign both means start at the plan: a wheel follows until its counts say otherwise.
///
namespace robot_control {

class WheelProgress {
 public:
  /// The part of its plan from which on a wheel counts as turning.
  static constexpr double kTurns = 0.2;

  /// `angle` rad: the next sample is compared with it.
  void restart_from(double angle) noexcept;

  /// rad/s planned for this sample's time, rad measured, rad of a count (encoder_quantum.h); `dt` > 0, s, since the
  /// last sample.
  void step(double planned, double angle, double quantum, double dt) noexcept;

  double held() const noexcept { return held_; }  ///< −1 … 1

 private:
  double angle_ = 0;
  double planned_ = 0;
  double speed_ = 0;
  double held_ = 0;
};

}  // namespace robot_control
