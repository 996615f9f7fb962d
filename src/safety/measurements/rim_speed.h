#pragma once
/// The speed of the robot along its x axis, as the mean rim speed of its drive wheels. It belongs to the point in the
/// middle of the axles. It is the drives' own velocity, so it needs no samples of earlier cycles.

#include <array>
#include <cstddef>

#include "machine/wheeled/drive_train.h"
#include "signals/sensor_frame.h"

namespace robot_control {

class RimSpeed {
 public:
  explicit RimSpeed(const DriveTrain& robot) noexcept;

  /// Returns the speed in m/s; 0 while the joint samples are not valid or not finite.
  double value(const SensorFrame& sensors) const noexcept;

 private:
  struct Wheel {
    std::size_t joint = 0;
    double rim_per_joint = 0;  ///< m/s per rad/s, forwards
  };

  std::size_t count_;
  std::array<Wheel, kMaxWheels> wheels_{};
};

}  // namespace robot_control
