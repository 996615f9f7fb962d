#pragma once
/// Decides whether all wheels stand: each has moved less than kStandstillSpeed·kStandstillTime for kStandstillTime.
///
/// Angles are compared instead of speeds. One encoder count (0.0015 rad of 4096) lifts every filtered speed above the
/// threshold, but does not leave the angle window of 0.005 rad.

#include <cstdint>
#include <optional>

#include "control/wheeled/planar_twist.h"

namespace robot_control {

inline constexpr double kStandstillSpeed = 0.02;  ///< rad/s; 2 mm/s on a 0.1 m wheel
inline constexpr double kStandstillTime = 0.25;   ///< s; longer than the wheel loops need to settle

class Standstill {
 public:
  /// `period` is in s, > 0.
  explicit Standstill(double period);

  /// Restarts; the robot may be moving.
  void reset() noexcept { since_.reset(); }

  /// `angles` are in rad for every wheel's joint; `cycle` is that of the sample.
  void step(const WheelValues& angles, std::uint64_t cycle) noexcept;

  bool standing() const noexcept { return since_ && cycles_ >= cycles_needed_; }
  std::uint64_t cycles() const noexcept { return cycles_; }  ///< cycles for which all angles have stayed in the window
  std::uint64_t cycles_needed() const noexcept { return cycles_needed_; }  ///< kStandstillTime in cycles

 private:
  std::uint64_t cycles_needed_;
  std::uint64_t cycles_ = 0;
  WheelValues anchor_{};
  std::optional<std::uint64_t> since_;  ///< cycle of `anchor_`
};

}  // namespace robot_control
