#pragma once
/// Reads the wheels of both sides: their travel since the last readings, their speeds, and which side is lost.
///
/// A side is lost if no reading was accepted for kMaxHeld periods and for twice the usual gap between its readings. The
/// other side replaces it if the turn of the robot is known. Otherwise it counts as standing.

#include <array>
#include <cmath>

#include "estimation/wheeled/wheels/side_encoder.h"
#include "estimation/wheeled/wheels/speed_quantum.h"
#include "machine/wheeled/drive_train.h"
#include "signals/sensor_frame.h"

namespace robot_control {

/// Holds what the wheels show in one step; the arrays hold left and right.
struct WheelReading {
  std::array<double, 2> travel{};        ///< m, since the last readings; 0 without a reading in this step
  std::array<double, 2> speed{};         ///< m/s, tracked
  std::array<bool, 2> received{};        ///< A reading was accepted in this step.
  std::array<bool, 2> lost{};            ///< The side is lost.
  std::array<double, 2> unknown_time{};  ///< s, in which a travel that is now lost was made; 0: none was lost
  std::array<double, 2> lost_speed{};    ///< m/s, last one of a side that is lost and not replaced
  double lost_time = 0;                  ///< s, since the last reading of such a side
  double unread = 0;                     ///< m, travel of the middle by sides without a reading, at their last speeds
  double gap = 0;                        ///< s, usual time between two readings
  double speed_step = 0;                 ///< m/s, in which speeds are reported; 0: none
  double travel_variance = 0;            ///< m², of each side's travel, by that step
  bool refused = false;                  ///< A reading was not used.
  bool restarted = false;    ///< A side began from a new offset; its travel does not continue the earlier one.
  bool fell_silent = false;  ///< Both are lost and had brought readings.
  bool batch = false;        ///< The readings were held up; their stamps give no speed.

  double left() const noexcept { return travel[0]; }
  double right() const noexcept { return travel[1]; }
  double mean() const noexcept { return (travel[0] + travel[1]) / 2; }
  double mean_speed() const noexcept { return (speed[0] + speed[1]) / 2; }
  /// Returns the deviation of mean_speed() by the sides that are lost and not replaced, m/s.
  double unknown_speed() const noexcept { return (std::abs(lost_speed[0]) + std::abs(lost_speed[1])) / 2; }
  bool both_received() const noexcept { return received[0] && received[1]; }
  bool any_lost() const noexcept { return lost[0] || lost[1]; }
  bool both_lost() const noexcept { return lost[0] && lost[1]; }
};

class WheelSides {
 public:
  /// `bandwidth` (Hz) is that of the speeds, `period` is in s, `count` (m) is one count of an encoder.
  WheelSides(const DriveTrain& robot, double bandwidth, double period, double count);

  /// `dt` is the time in s since the last call. `turns`: the turn of the robot is known.
  WheelReading step(const SensorFrame& sensors, double dt, bool turns) noexcept;
  void set_speed(double left, double right) noexcept;  ///< m/s
  /// Writes rad/s of the wheels in the joint's own sign.
  void write(std::array<double, kMaxJoints>& joint_velocity) const noexcept {
    for (const SideEncoder& side : sides_) side.write(joint_velocity);
  }

 private:
  bool lost(const SideEncoder& encoder) const noexcept;

  double longest_held_;  ///< s
  std::array<SideEncoder, 2> sides_;
  SpeedQuantum quantum_;
  double usual_gap_ = 0;  ///< s, between two readings
};

}  // namespace robot_control
