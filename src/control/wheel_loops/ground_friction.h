#pragma once
/// The torque that treads take in a turn, with the friction of the ground as the wheel loops find it.
///
/// Treads that scrub take μ·zᵢ, zᵢ their torque at friction 1 (scrub.h), of the planned motion; while this controller
/// is not in control, of the measured one. Feed-forward gives μ̂·zᵢ. The integrators Iᵢ find the rest, and would keep it
/// where the turn ends or reverses, as if it were a slope. So what they hold along z goes over to the estimate, in
/// every cycle:
///
///   Δ = w·Σ Iᵢ·zᵢ/Σ zᵢ²     μ̂ = μ̂ + Δ     Iᵢ = Iᵢ − Δ·zᵢ     0 ≤ μ̂ ≤ kMostGroundFriction
///   w = min(1, s/kLearningWay)·clamp(2·Σ zᵢ²/Σ z²_most − 1, 0, 1)     s = ρ·dt, by which treads slid (scrub.h)
///
/// The torque stays; from then on that part of it follows the treads. Slopes and masses stay with the integrators: they
/// load both sides alike, scrub loads them against each other. w: near straight, where z is small, a load on one side
/// would pass for a huge friction; and treads that rest say nothing about it.
///
/// Before anything was measured, a torque that is too much for the floor would throw the robot into its first turn. So
/// μ̂ begins with kLeastGround, which most floors exceed. While the planned treads slide and the wheels turn the robot
/// by less than kFollows of the plan, μ̂ rises with kSearch, up to kMostSearched; more is left to the integrators. The
/// search ends when treads have slid by kLearningWay while the robot turned as planned. Until it is seen to turn,
/// torque has gone on rising: that would surge. So an observer of the momentum finds how much the treads take. With T
/// all torque but that for the joints, and P what has accelerated the turn, both along z and per N·m of it,
///
///   r = (∫(T − r)·dt − P)/kObserverTime     when the robot begins to follow: μ̂ = min(μ̂, r − Σ Iᵢ·zᵢ/Σ zᵢ²)
///
/// Where the plan stands, z decays with kReleaseTime: at the edge of sliding the robot would creep. Where the wheels
/// stand and this controller is not in control, z is the part of their efforts that turns the robot, at most z_most.

#include <algorithm>
#include <cstddef>

#include "control/planar_twist.h"
#include "robot/robot_model.h"
#include "robot/wheels/scrub.h"

namespace robot_control {

/// A usual floor: between smooth wet ones, 0.5, and rubber on dry concrete, 1.
inline constexpr double kGroundFriction = 0.7;

/// Before the first turn: smooth wet floors.
inline constexpr double kLeastGround = 0.3;

/// The best grip.
inline constexpr double kMostGroundFriction = 3.0;

class GroundFriction {
 public:
  static constexpr double kReleaseTime = 0.5;     ///< s
  static constexpr double kLearningWay = 0.0025;  ///< m
  static constexpr double kSearch = 2.0;          ///< 1/s
  static constexpr double kFollows = 0.8;
  static constexpr double kMostSearched = 1.0;   ///< rubber on dry concrete
  static constexpr double kObserverTime = 0.04;  ///< s

  struct State {
    double friction = kLeastGround;  ///< μ̂
    WheelValues strain{};            ///< N·m, z
    double slid = 0;                 ///< m, of the last cycle, ρ·dt of scrub.h
    double found = 0;                ///< m, by which treads slid while the robot turned as planned
    bool follows = true;             ///< the last plan, by kFollows of it
    double impulse = 0;              ///< s, ∫(T − r)·dt
    double taken = 0;                ///< r
  };

  explicit GroundFriction(const RobotModel& robot) noexcept;

  /// A new run.
  void reset() noexcept { state_ = {}; }

  /// There is such a torque; else nothing of this class need be called.
  bool scrubs() const noexcept { return most_ > 0; }

  /// The robot moves with `twist` for `dt` s.
  void move(const PlanarTwist& twist, double dt) noexcept {
    state_.slid = scrub_.strain(state_.strain, twist.linear, twist.angular, dt);
    if (twist.linear != 0 || twist.angular != 0) return;
    for (double& strain : state_.strain) strain -= std::min(1.0, dt / kReleaseTime) * strain;
  }

  /// The robot stands, and its wheels hold `effort(i)`, N·m: what of it turns is taken for strain.
  template <class Effort>
  void rest(Effort effort) noexcept {
    double held = 0;
    for (std::size_t i = 0; i < wheels_; ++i) held += scrub_.most_to_left(i) * effort(i);
    const double most = std::max(state_.friction, kLeastFriction) * most_;
    for (std::size_t i = 0; i < wheels_; ++i)
      state_.strain[i] = std::clamp(held / most, -1.0, 1.0) * scrub_.most_to_left(i);
  }

  /// Δ: the caller moves Δ·z from the integrators to the feed-forward. `integral(i)`: Iᵢ, N·m.
  template <class Integral>
  double take(Integral integral) noexcept {
    const double square = strain_square();
    if (turns(square) <= 0) return 0;
    return raise(std::min(1.0, state_.slid / kLearningWay) * turns(square) * sum_along(integral) / square);
  }

  bool searches() const noexcept { return state_.found < kLearningWay; }

  /// The robot's turn; efforts along z and per N·m of it, as frictions.
  struct Turn {
    double part = 0;      ///< of the planned yaw rate
    double integral = 0;  ///< Σ Iᵢ·zᵢ/Σ zᵢ²
    double effort = 0;    ///< T
    double momentum = 0;  ///< s, P
  };

  /// While it `searches`; `dt` s since the last call.
  void search(const Turn& turn, double dt) noexcept;

  /// Σ effort(i)·zᵢ/Σ zᵢ², a friction. 0 without strain.
  template <class Effort>
  double along(Effort effort) const noexcept {
    const double square = strain_square();
    return square > 0 ? sum_along(effort) / square : 0;
  }

  double strain(std::size_t wheel) const noexcept { return state_.strain[wheel]; }                    ///< N·m, z
  double effort(std::size_t wheel) const noexcept { return state_.friction * state_.strain[wheel]; }  ///< N·m
  double friction() const noexcept { return state_.friction; }                                        ///< μ̂

 private:
  static constexpr double kLeastFriction = 0.05;

  /// N²·m², Σ effort(i)·zᵢ
  template <class Effort>
  double sum_along(Effort effort) const noexcept {
    double sum = 0;
    for (std::size_t i = 0; i < wheels_; ++i) sum += state_.strain[i] * effort(i);
    return sum;
  }

  /// N²·m², Σ zᵢ²
  double strain_square() const noexcept {
    return sum_along([&](std::size_t i) { return state_.strain[i]; });
  }

  /// 1: all treads slide in a turn; ≤ 0: near straight.
  double turns(double square) const noexcept { return std::min(1.0, 2 * square / most_ - 1); }

  double raise(double by) noexcept;

  Scrub scrub_;
  std::size_t wheels_;
  double most_ = 0;  ///< N²·m², Σ z²_most
  State state_;
};

}  // namespace robot_control
