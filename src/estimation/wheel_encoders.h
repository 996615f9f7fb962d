#pragma once
/// Encoder angles → travel of either side, as differences to the last angles that were believed.
///
///   travel = mean over the side's wheels of signᵢ · radiusᵢ · (qᵢ − qᵢ,last)    [m]
///
/// All wheels are read together: one whose sample is not used rejects the reading. The first reading, and the first
/// after `reset`, is the offset: no travel. A sample that is missing, not finite or impossible is not used; the next
/// good one brings the travel of the whole gap. Impossible is a difference above 2 · velocity_limit (1000 rad/s where
/// the robot names none) times the time passed, plus kSlack. An encoder that stays impossible for more than
/// kMaxRejected readings was set anew: then the present angles become the offset, and the travel in between is lost.

#include <cstdint>
#include <vector>

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

  /// At least one wheel on either side.
  explicit WheelEncoders(const RobotModel& robot);

  void reset() noexcept;

  /// `time`: s since the last reading that was not rejected.
  EncoderReading step(const SensorFrame& sensors, double time) noexcept;

  double left() const noexcept { return left_; }    ///< m
  double right() const noexcept { return right_; }  ///< m

  /// Angular speed as the driver measured it, times the radius; 0 where that is no number. Mean of the side.
  double left_speed(const SensorFrame& sensors) const noexcept;   ///< m/s
  double right_speed(const SensorFrame& sensors) const noexcept;  ///< m/s

 private:
  struct Wheel {
    std::size_t joint;
    Side side;
    double metres_per_radian;
    double velocity_bound;  ///< rad/s
    double angle = 0;       ///< rad, as last believed

    Wheel(const WheelModel& wheel, const RobotModel& robot) noexcept;
    bool measured(const SensorFrame& sensors) const noexcept;
    bool plausible(const SensorFrame& sensors, double time) const noexcept;
    double take(const SensorFrame& sensors) noexcept;  ///< m, travel
    double speed(const SensorFrame& sensors) const noexcept;
  };

  double speed(const SensorFrame& sensors, Side side) const noexcept;

  std::vector<Wheel> wheels_;
  double share_left_;  ///< of one wheel in its side
  double share_right_;
  double left_ = 0;   ///< m
  double right_ = 0;  ///< m
  bool known_ = false;
  std::uint64_t rejected_ = 0;  ///< impossible readings in a row
};

}  // namespace robot_control
