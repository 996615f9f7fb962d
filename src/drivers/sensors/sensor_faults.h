#pragma once
/// Encoders, gyro, accelerometer, battery gauge and e-stop button with injected faults; what they report, by component
/// and kind:
///
///                 encoders of a side (all its wheels)           gyro, accelerometer
///   off           position and velocity NaN: the drive          not valid (SensorFrame::valid), NaN
///                 lives, but has no number to report
///   stuck         the angle stays, velocity 0                   the sample stays
///   garbage       angle within a turn of where it began,        within the range of a BMI088: ±2000 °/s, ±24 g
///                 velocity within ±kGarbageSpeed, uniform       on each axis, uniform
///   wrong         counts backwards from where it began,         every axis has the other sign
///                 velocity with the other sign
///   slow          a sample every 10 cycles, held in between
///   delayed       the sample of 10 cycles ago
///   intermittent  as off, and healthy, at random
///
///                 battery, where there is one                   e-stop button, not pressed
///   off           not valid, NaN                                pressed: its contacts open like a cut wire (ISO 13850)
///   stuck         voltage and current stay                      pressed, jammed
///   garbage       voltage within twice, current within          pressed or not, new in every cycle
///                 ±kGarbageCurrent, uniform
///   wrong         kWrongVoltage of the voltage                  pressed
///   slow          a sample every 10 cycles, held in between     not pressed
///   delayed       the sample of 10 cycles ago                   not pressed
///   intermittent  as off, and healthy, at random                pressed and not, at random: a loose wire
///
/// When and how long, see faults/faulty_output.h. Efforts and temperatures stay: the drive itself is well. All else of
/// a frame is untouched. What is valid stays so in every kind but off: a device does not detect its own wrong values.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "drivers/sensors/sensor_errors.h"
#include "faults/faulty_output.h"
#include "robot/robot_model.h"
#include "signals/sensor_frame.h"

namespace robot_control {

class SensorFaults {
 public:
  static constexpr double kGarbageSpeed = 100;          ///< rad/s
  static constexpr double kGyroRange = 34.9;            ///< rad/s
  static constexpr double kAccelerometerRange = 235.4;  ///< m/s²
  static constexpr double kGarbageCurrent = 100;        ///< A
  static constexpr double kWrongVoltage = 0.6;          ///< below that of any charged battery

  SensorFaults(const RobotModel& robot, std::uint64_t seed);

  /// Without faults, as at the start.
  void reset() noexcept;

  /// Once per cycle: healthy samples in, the faulty samples in their place. Bits of SensorValidity: what is not valid
  /// any more. Real-time safe.
  std::uint64_t step(const InjectedFaults& faults, std::uint64_t cycle, Measurement& measurement) noexcept;

 private:
  struct Reading {
    double position = 0;
    double velocity = 0;
  };
  using Readings = std::array<Reading, kMaxWheels>;

  struct Encoders {
    std::vector<std::size_t> joints;
    FaultyOutput<Readings> output;
  };

  static void step_encoders(Encoders& encoders, FaultKind kind, std::uint64_t cycle, Measurement& measurement) noexcept;

  bool failing_ = false;  ///< in the last step
  Encoders left_, right_;
  FaultyOutput<Vector3> gyro_, accelerometer_;
  FaultyOutput<BatterySample> battery_;
  FaultyOutput<bool> button_;
};

}  // namespace robot_control
