#pragma once
/// Tracks the wheels of both sides: their travel since the last readings, their speeds, and which side is lost.
///
/// A side is lost if no reading was accepted for kMaxHeld periods and for twice the usual gap between its readings.
/// Then the other side replaces it:
///
///   distance of the middle of the wheels = travel of the side ± turn · wheel_base / 2        + for the left side
///
/// The travel that was replaced is deducted from the first reading after the gap.

#include <array>
#include <cstddef>

#include "estimation/wheels/side_encoder.h"
#include "estimation/wheels/speed_quantum.h"
#include "estimation/wheels/speed_tracker.h"
#include "estimation/wheels/stamp_jitter.h"
#include "estimation/wheels/wheel_geometry.h"
#include "robot/robot_model.h"
#include "signals/fixed_vector.h"
#include "signals/sensor_frame.h"

namespace robot_control {

class WheelSides {
 public:
  static constexpr std::size_t kLeft = 0, kRight = 1;

  /// Describes the result of one step.
  struct Readings {
    bool refused = false;    ///< A reading was not used.
    bool restarted = false;  ///< A side began from a new offset; its travel does not continue the earlier one.
    int lost_travels = 0;    ///< sides with an unknown travel lost
  };

  /// Holds the travel of the middle of the wheels.
  struct Travel {
    double distance = 0;    ///< m
    double turn_since = 0;  ///< rad, turned since half of that travel
  };

  /// `bandwidth` (Hz) is that of the speeds, `period` is in s, `count` (m) is one count of an encoder.
  WheelSides(const RobotModel& robot, double bandwidth, double period, double count);

  Readings step(const SensorFrame& sensors, double dt) noexcept;
  void turn(double angle) noexcept;  ///< rad, of the robot in this step
  void forget_turn() noexcept;       ///< forgets the turn since the last readings
  /// Returns the travels by which this step's readings move the path. `ratio` is the radius ratio − 1.
  FixedVector<Travel, 2> take_travels(double ratio) noexcept;
  /// Updates `recent_speed` over `lateness` s, at least one gap. It is called once per step with readings of both
  /// sides.
  void average_speed(double lateness) noexcept;
  void set_speed(double speed, double rate) noexcept;  ///< m/s of the middle, rad/s

  double left() const noexcept { return travel(kLeft); }    ///< m, travel of this step's reading
  double right() const noexcept { return travel(kRight); }  ///< m
  double mean() const noexcept { return (left() + right()) / 2; }
  double turned() const noexcept { return geometry_.turn(left(), right()); }  ///< rad, by the model's wheel base
  double side_speed(std::size_t side) const noexcept { return sides_[side].speed.speed(); }                   ///< m/s
  double speed() const noexcept { return (sides_[kLeft].speed.speed() + sides_[kRight].speed.speed()) / 2; }  ///< m/s
  double rate() const noexcept {  ///< rad/s, by the model's wheel base
    return geometry_.turn(sides_[kLeft].speed.speed(), sides_[kRight].speed.speed());
  }
  /// Returns the speed of the middle, in m/s. If one side is lost, it follows from the other side and the yaw rate
  /// `rate` (rad/s).
  double speed_at(double rate) const noexcept;
  /// Returns the mean speed over the lateness, in m/s. One reading alone is inaccurate if stamps jitter or counts are
  /// few.
  double recent_speed() const noexcept { return recent_time_ > 0 ? recent_distance_ / recent_time_ : 0; }
  /// Returns the travel of the middle by a side without a reading in this step, at its last speed, in m.
  double unread_distance(std::size_t side) const noexcept;
  const SpeedQuantum& quantum() const noexcept { return quantum_; }      ///< quantum of the left side's speeds
  double stamp_variance() const noexcept { return jitter_.variance(); }  ///< s²

  bool received(std::size_t side) const noexcept { return sides_[side].encoder.received(); }
  bool both_received() const noexcept { return received(kLeft) && received(kRight); }
  bool lost(std::size_t side) const noexcept;
  bool any_lost() const noexcept { return lost(kLeft) || lost(kRight); }
  bool both_lost() const noexcept { return lost(kLeft) && lost(kRight); }
  bool both_fell_silent() const noexcept;  ///< Both are lost and had brought readings.
  /// Returns true if the readings came much closer than usual: they were held up, and their stamps give no speed. It
  /// must be called once per step.
  bool in_a_batch() noexcept;

 private:
  struct SideState {
    SideEncoder encoder;
    SpeedTracker speed;
    double turned = 0;    ///< rad since its last reading
    double credited = 0;  ///< m by which the other side replaced this one
  };

  double travel(std::size_t side) const noexcept { return sides_[side].encoder.travel(); }
  Travel take_travel(std::size_t side) noexcept;

  WheelGeometry geometry_;
  double longest_held_;  ///< s
  std::array<SideState, 2> sides_;
  StampJitter jitter_;
  SpeedQuantum quantum_;
  double recent_distance_ = 0, recent_time_ = 0;  ///< m, s, both fading
  double usual_gap_ = 0;                          ///< s, between two readings
};

}  // namespace robot_control
