#pragma once
/// Learns the torque that treads take in a turn, with the friction of the ground as the wheel loops find it.
///
/// Treads that scrub take the torque μ·zᵢ, where zᵢ is their torque at friction 1 (scrub.h). The vector z belongs to
/// the planned motion, or to the measured one while this controller is not in control. Feed-forward gives μ̂·zᵢ, and
/// the integrators Iᵢ find the rest. They would keep it at the end or the reversal of a turn, as if it were a slope.
/// Therefore the part that they hold along z moves to the estimate in every cycle:
///
///   Δ = w·Σ Iᵢ·zᵢ/Σ zᵢ²     μ̂ = μ̂ + Δ     Iᵢ = Iᵢ − Δ·zᵢ     0 ≤ μ̂ ≤ kMaxGroundFriction
///   w = min(1, s/kLearningWay)·clamp(2·Σ zᵢ²/Σ z²_most − 1, 0, 1)     s = ρ·dt
///
/// The distance s is that by which treads slid (scrub.h). The total torque stays. From then on that part of it follows
/// the treads. Slopes and masses stay with the integrators: they load both sides alike, while scrub loads them against
/// each other. The weight w excludes two cases. Near straight z is small, and a load on one side would look like a huge
/// friction. Treads that rest show nothing about the friction.
///
/// A torque that is too much for the floor would throw the robot into its first turn. Therefore μ̂ begins with
/// kInitialGroundFriction, which most floors exceed. It rises with kSearchRate, up to kMaxSearched, while the planned
/// treads slide and the wheels turn the robot by less than kFollowedShare of the plan. The integrators find more. The
/// search ends when treads have slid by kLearningWay while the robot turned as planned.
///
/// The torque rises until the turn is seen, which would let the robot surge. Therefore an observer of the momentum
/// finds the friction that the treads take. T is all torque but that for the joints, and P the momentum of the turn.
/// Both are projected on z and divided by Σ zᵢ²:
///
///   r = (∫(T − r)·dt − P)/kObserverTime     when the robot begins to follow: μ̂ = min(μ̂, r − Σ Iᵢ·zᵢ/Σ zᵢ²)
///
/// Once the plan stands, z decays with kReleaseTime, because the robot would creep at the edge of sliding. While the
/// wheels stand without control, z is the part of their efforts that turns the robot, at most z_most.

#include <algorithm>
#include <cstddef>

#include "control/wheeled/planar_twist.h"
#include "machine/wheeled/drive_train.h"
#include "machine/wheeled/scrub.h"

namespace robot_control {

/// This is the friction before the first turn; most floors exceed it.
inline constexpr double kInitialGroundFriction = 0.3;

/// This is the friction of the best grip.
inline constexpr double kMaxGroundFriction = 3.0;

class GroundFriction {
 public:
  static constexpr double kReleaseTime = 0.5;     ///< s
  static constexpr double kLearningWay = 0.0025;  ///< m
  static constexpr double kSearchRate = 2.0;      ///< 1/s
  static constexpr double kFollowedShare = 0.8;
  static constexpr double kMaxSearched = 1.0;    ///< friction of rubber on dry concrete
  static constexpr double kObserverTime = 0.04;  ///< s

  struct State {
    double friction = kInitialGroundFriction;  ///< μ̂
    WheelValues strain{};                      ///< N·m, z
    double slid = 0;                           ///< m, in the last cycle; ρ·dt of scrub.h
    double found = 0;                          ///< m by which treads slid while the robot turned as planned
    bool follows = true;                       ///< The robot follows the last plan by kFollowedShare of it.
    double impulse = 0;                        ///< s, ∫(T − r)·dt
    double taken = 0;                          ///< r
  };

  explicit GroundFriction(const DriveTrain& robot) noexcept;

  /// Begins a new run.
  void reset() noexcept { state_ = {}; }

  /// Returns true if treads scrub; else no other function of this class needs to be called.
  bool scrubs() const noexcept { return max_square_ > 0; }

  /// Updates z while the robot moves with `twist` for `dt` s.
  void move(const PlanarTwist& twist, double dt) noexcept {
    state_.slid = scrub_.strain(state_.strain, twist.linear, twist.angular, dt);
    if (twist.linear != 0 || twist.angular != 0) return;
    for (double& strain : state_.strain) strain -= std::min(1.0, dt / kReleaseTime) * strain;
  }

  /// Sets z while the robot stands and its wheels hold `effort(i)`, N·m: their turning part counts as strain.
  template <class Effort>
  void rest(Effort effort) noexcept {
    double held = 0;
    for (std::size_t i = 0; i < wheels_; ++i) held += scrub_.max_effort_to_left(i) * effort(i);
    const double limit = std::max(state_.friction, kMinFriction) * max_square_;
    for (std::size_t i = 0; i < wheels_; ++i)
      state_.strain[i] = std::clamp(held / limit, -1.0, 1.0) * scrub_.max_effort_to_left(i);
  }

  /// Returns Δ; the caller moves Δ·z from the integrators to the feed-forward. `integral(i)` is Iᵢ, N·m.
  template <class Integral>
  double learn(Integral integral) noexcept {
    const double square = strain_square();
    if (turns(square) <= 0) return 0;
    return raise(std::min(1.0, state_.slid / kLearningWay) * turns(square) * sum_along(integral) / square);
  }

  bool searches() const noexcept { return state_.found < kLearningWay; }

  /// Describes the robot's turn, with efforts along z over Σ zᵢ², as frictions.
  struct Turn {
    double part = 0;      ///< share of the planned yaw rate
    double integral = 0;  ///< Σ Iᵢ·zᵢ/Σ zᵢ²
    double effort = 0;    ///< T
    double momentum = 0;  ///< s, P
  };

  /// Updates the observer and μ̂ while it `searches`; `dt` (s) is the time since the last call.
  void search(const Turn& turn, double dt) noexcept;

  /// Returns the friction Σ effort(i)·zᵢ/Σ zᵢ²; 0 without strain.
  template <class Effort>
  double along(Effort effort) const noexcept {
    const double square = strain_square();
    return square > 0 ? sum_along(effort) / square : 0;
  }

  double strain(std::size_t wheel) const noexcept { return state_.strain[wheel]; }                    ///< N·m, z
  double effort(std::size_t wheel) const noexcept { return state_.friction * state_.strain[wheel]; }  ///< N·m
  double friction() const noexcept { return state_.friction; }                                        ///< μ̂

 private:
  static constexpr double kMinFriction = 0.05;

  /// Returns Σ effort(i)·zᵢ, N²·m².
  template <class Effort>
  double sum_along(Effort effort) const noexcept {
    double sum = 0;
    for (std::size_t i = 0; i < wheels_; ++i) sum += state_.strain[i] * effort(i);
    return sum;
  }

  /// Returns Σ zᵢ², N²·m².
  double strain_square() const noexcept {
    return sum_along([&](std::size_t i) { return state_.strain[i]; });
  }

  /// Returns 1 if all treads slide in a turn, ≤ 0 near straight.
  double turns(double square) const noexcept { return std::min(1.0, 2 * square / max_square_ - 1); }

  double raise(double by) noexcept;

  Scrub scrub_;
  std::size_t wheels_;
  double max_square_ = 0;  ///< N²·m², Σ z²_most
  State state_;
};

}  // namespace robot_control
