#pragma once
/// A SampleTime holds when a joint was sampled that a law used last, so that the law uses each sample once.

#include <cstdint>

#include "signals/sensor_frame.h"

namespace robot_control {

class SampleTime {
 public:
  /// Returns whether the sample is younger than the accepted one. A sample without age is always new.
  bool precedes(const SensorFrame& sensors, const JointSample& sample) const noexcept {
    return sample.age_ns <= 0 || !known_ || time_of(sensors, sample) > accepted_ns_;
  }

  void accept(const SensorFrame& sensors, const JointSample& sample) noexcept {
    accepted_ns_ = time_of(sensors, sample);
    known_ = true;
  }

 private:
  static std::int64_t time_of(const SensorFrame& sensors, const JointSample& sample) noexcept {
    return sensors.head.stamp_ns - sample.age_ns;
  }

  std::int64_t accepted_ns_ = 0;
  bool known_ = false;
};

}  // namespace robot_control
