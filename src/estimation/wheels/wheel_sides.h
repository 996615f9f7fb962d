#pragma once
/// The wheels of both sides: what they rolled since their last readings, how fast they are, and which side is lost.
///
/// A side is lost where no reading was accepted for kMaxHeld periods and for twice the usual gap between its readings.
/// The other side then stands for it:
///
///   distance of the middle of the wheels = travel of the side ± turn · wheel_base / 2        + for the left side
///
/// and what it stood for is deducted from the first reading with which the lost side comes back.

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

  /// Of one step.
  struct Readings {
    bool refused = false;    ///< a reading was not used
    bool restarted = false;  ///< a side began from a new offset: its travel is not that of the time before
    int lost_travels = 0;    ///< sides of which an unknown travel was lost
  };

  /// Of the middle of the wheels.
  struct Travel {
    double distance = 0;    ///< m
    double turn_since = 0;  ///< rad, turned since half of it
  };

  /// `bandwidth` Hz of the speeds, `period` s, `count` m: of an encoder.
  WheelSides(const RobotModel& robot, double bandwidth, double period, double count);

  Readings step(const SensorFrame& sensors, double dt) noexcept;
  void turn(double angle) noexcept;  ///< rad, of the robot in this step
  void forget_turn() noexcept;       ///< what was turned since the last readings is accounted for
  /// What the readings of this step make of the path. `ratio`: radius ratio − 1.
  FixedVector<Travel, 2> take_travels(double ratio) noexcept;
  /// Once per step with a reading of both: `lateness` s, over which `recent_speed` is the mean, one gap at least.
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
  /// m/s of the middle; of the side that is left where the other is lost, at the yaw rate `rate` rad/s.
  double speed_at(double rate) const noexcept;
  /// m/s, mean speed over the lateness: one reading alone is a poor speed where stamps jitter or counts are few.
  double recent_speed() const noexcept { return recent_time_ > 0 ? recent_distance_ / recent_time_ : 0; }
  /// m, of the middle: what a side without a reading in this step rolled since its last one, at its speed.
  double unread_distance(std::size_t side) const noexcept;
  const SpeedQuantum& quantum() const noexcept { return quantum_; }      ///< of either side
  double stamp_variance() const noexcept { return jitter_.variance(); }  ///< s²

  bool received(std::size_t side) const noexcept { return sides_[side].encoder.received(); }
  bool both_received() const noexcept { return received(kLeft) && received(kRight); }
  bool lost(std::size_t side) const noexcept;
  bool any_lost() const noexcept { return lost(kLeft) || lost(kRight); }
  bool both_lost() const noexcept { return lost(kLeft) && lost(kRight); }
  bool both_fell_silent() const noexcept;  ///< both are lost, and had brought readings
  /// Readings that come much closer than usual were held up on their way: their stamps give no speed.
  /// Once per step.
  bool in_a_batch() noexcept;

 private:
  struct SideState {
    SideEncoder encoder;
    SpeedTracker speed;
    double turned = 0;    ///< rad, since its last reading
    double credited = 0;  ///< m, that the other side stood for while this one was lost
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
