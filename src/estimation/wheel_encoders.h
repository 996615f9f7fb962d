#pragma once
/// Encoder angles → travel of both wheels, as differences to the last angles that were believed.
///
///   travel = sign · radius · (q − q_last)    [m]
///
/// The first reading, and the first after `reset`, is the offset: no travel. A sample that is missing, not finite
/// or impossible is not used; the next good one brings the travel of the whole gap. Impossible is a difference
/// above 2 · velocity_limit (1000 rad/s where the robot names none) times the time passed, plus kSlack. An
/// encoder that stays impossible for more than kMaxRejected readings was set anew: then the present angles
/// become the offset, and the travel in between is lost.

#include <cstdint>

#include "robot/robot_model.h"
#include "signals/sensor_frame.h"

namespace robot_control {

enum class EncoderReading : std::uint8_t {
  kTravel,    ///< `left`, `right` hold the travel
  kOffset,    ///< first reading
  kLost,      ///< the angles began anew: an unknown travel was lost
  kRejected,  ///< not used
};

class WheelEncoders {
 public:
  static constexpr std::uint64_t kMaxRejected = 4;
  static constexpr double kSlack = 0.1;  ///< rad; some counts of a coarse encoder, and backlash

  explicit WheelEncoders(const RobotModel& robot) noexcept;

  void reset() noexcept;

  /// `time`: s since the last reading that was not rejected.
  EncoderReading step(const SensorFrame& sensors, double time) noexcept;

  double left() const noexcept { return left_.travel; }    ///< m
  double right() const noexcept { return right_.travel; }  ///< m

  /// Angular speed as the driver measured it, times the radius; 0 where that is no number.
  double left_speed(const SensorFrame& sensors) const noexcept { return left_.speed(sensors); }    ///< m/s
  double right_speed(const SensorFrame& sensors) const noexcept { return right_.speed(sensors); }  ///< m/s

 private:
  struct Wheel {
    std::size_t joint;
    double metres_per_radian;
    double velocity_bound;  ///< rad/s
    double angle = 0;       ///< rad, as last believed
    double travel = 0;      ///< m

    Wheel(const WheelModel& wheel, const RobotModel& robot) noexcept;
    bool measured(const SensorFrame& sensors) const noexcept;
    bool plausible(const SensorFrame& sensors, double time) const noexcept;
    void take(const SensorFrame& sensors) noexcept;
    double speed(const SensorFrame& sensors) const noexcept;
  };

  Wheel left_;
  Wheel right_;
  bool known_ = false;
  std::uint64_t rejected_ = 0;  ///< impossible readings in a row
};

}  // namespace robot_control
