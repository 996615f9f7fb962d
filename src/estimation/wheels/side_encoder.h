#pragma once
/// Encoder angles of one side's wheels → travel of that side, as differences to the last angles that were accepted.
///
///   travel = mean over the side's wheels of signᵢ · radiusᵢ · (qᵢ − qᵢ,last)    [m]
///
/// The side's wheels are read together: one whose sample is not used rejects the reading. The first reading is the
/// offset: no travel. A sample that is missing, not finite or impossible is not used; the next good one brings the
/// travel of the whole gap. Impossible is a difference above 2 · velocity_limit (1000 rad/s where the robot names none)
/// times the time passed, plus kEncoderSlack. An encoder that stays impossible for more than kMaxHeld readings was
/// reset: then the present angles become the offset, and the travel in between is lost.

#include <cstdint>

#include "robot/robot_model.h"
#include "signals/fixed_vector.h"
#include "signals/sensor_frame.h"

namespace robot_control {

enum class EncoderReading : std::uint8_t {
  kTravel,    ///< `travel` holds the travel
  kOffset,    ///< first reading
  kLost,      ///< the angles restarted: an unknown travel was lost
  kRejected,  ///< not used
};

class SideEncoder {
 public:
  /// At least one wheel on that side.
  SideEncoder(const RobotModel& robot, Side side);

  /// `dt`: s since the last call.
  EncoderReading step(const SensorFrame& sensors, double dt) noexcept;

  /// Since the last reading that was not rejected; 0 but after kTravel. m
  double travel() const noexcept { return travel_; }
  /// In which that travel was made. s
  double time() const noexcept { return time_; }
  /// A reading was accepted in the last step.
  bool received() const noexcept { return waiting_ == 0 && known_; }
  bool known() const noexcept { return known_; }        ///< a reading was accepted in this run
  double waiting() const noexcept { return waiting_; }  ///< s since a reading was accepted
  /// s, usual gap between readings: the largest, fading by kGapFading per reading, as stamps jitter and readings come
  /// in batches; at most kLongestGap.
  double gap() const noexcept { return gap_; }

 private:
  struct Wheel {
    std::size_t joint;
    double metres_per_radian;
    double velocity_bound;  ///< rad/s
    double angle = 0;       ///< rad, as last accepted

    Wheel(const WheelModel& wheel, const RobotModel& robot) noexcept;
    bool measured(const SensorFrame& sensors) const noexcept;
    bool plausible(const SensorFrame& sensors, double time) const noexcept;
    double take(const SensorFrame& sensors) noexcept;  ///< m, travel
  };

  FixedVector<Wheel, kMaxWheels> wheels_;
  double travel_ = 0;
  double time_ = 0;
  double waiting_ = 0;
  double gap_ = 0;
  bool known_ = false;
  std::uint64_t rejected_ = 0;  ///< impossible readings in a row
};

}  // namespace robot_control
