#pragma once
/// Speeds and accelerations of the wheels, from raw encoder angles alone.
///
///   speed         ω = (q_k − q_j)/((k − j)·period),  j the newest received cycle with k − j ≥ n
///   acceleration  (ω_k − ω_j)/((k − j)·period), of two adjacent windows
///   n = max(2, ⌈kSpeedWindow/period⌉), at most kMaxWindow (2 kHz)
///
/// Differencing over one period has the resolution 2π/(counts·period): 1.5 rad/s for 4096 counts at 1 kHz. Over the
/// window T the resolution is quantum/T = 0.08 rad/s, at the price of a lag of T/2.
///
///   quantum       the smallest step of an angle, or change of step, in this run: a single count, because a robot
///                 starts from rest; at speed, steps of 65 and 66 counts give it, too. Steps below kMinQuantum are
///                 ignored: an encoder of 2²² counts needs no tolerance.
///   tolerances    quantum/T for a speed, 2 quanta/T² for an acceleration: the largest error by quantisation
///
/// Skipped cycles, and samples that are missing, not valid or not finite, make a window longer, up to twice its length.
/// Beyond that speed and acceleration are not known.

#include <array>
#include <cstddef>
#include <cstdint>

#include "signals/sensor_frame.h"
#include "signals/wheeled/wheel_count.h"

namespace robot_control {

class WheelMotion {
 public:
  static constexpr std::uint64_t kMaxWindow = 40;  ///< cycles
  static constexpr double kMinQuantum = 1e-6;      ///< rad

  /// The first `wheels` joints. `period` s.
  WheelMotion(std::size_t wheels, double period) noexcept;

  /// A new run: speed and acceleration are not known.
  void enter_run() noexcept;

  void step(const SensorFrame& sensors) noexcept;

  std::size_t wheels() const noexcept { return wheels_; }

  /// This cycle has valid angles.
  bool sampled() const noexcept { return sampled_; }
  bool speed_known() const noexcept { return speed_known_; }
  bool acceleration_known() const noexcept { return acceleration_known_; }

  double angle(std::size_t wheel) const noexcept { return angle_[wheel]; }                ///< rad
  double speed(std::size_t wheel) const noexcept { return speed_[wheel]; }                ///< rad/s
  double acceleration(std::size_t wheel) const noexcept { return acceleration_[wheel]; }  ///< rad/s²
  double quantum(std::size_t wheel) const noexcept { return quantum_[wheel]; }            ///< rad; 0: not known yet
  double speed_tolerance(std::size_t wheel) const noexcept { return speed_tolerance_[wheel]; }
  double acceleration_tolerance(std::size_t wheel) const noexcept { return acceleration_tolerance_[wheel]; }

 private:
  using Values = std::array<double, kMaxWheels>;

  struct Sample {
    std::uint64_t cycle = kNoCycle;
    Values angle{};
  };
  static constexpr std::uint64_t kNoCycle = ~std::uint64_t{0};
  static constexpr std::size_t kSlots = 256;  // two windows of twice the length, and more

  bool read_angles(const SensorFrame& sensors) noexcept;
  void refine_quanta(const Values& angle) noexcept;
  void refine_quantum(std::size_t wheel, double candidate) noexcept;
  const Sample* before(std::uint64_t cycle) const noexcept;

  std::size_t wheels_;
  double period_;
  std::uint64_t window_cycles_;
  double window_;  ///< s
  bool sampled_ = false;
  bool speed_known_ = false;
  bool acceleration_known_ = false;
  bool stepped_ = false;  ///< `last_step_` is valid
  std::uint64_t newest_ = kNoCycle;
  Values angle_{};
  Values last_step_{};
  Values speed_{};
  Values acceleration_{};
  Values quantum_{};
  Values speed_tolerance_{};
  Values acceleration_tolerance_{};
  std::array<Sample, kSlots> samples_{};  ///< of cycle c in slot c mod kSlots
};

}  // namespace robot_control
