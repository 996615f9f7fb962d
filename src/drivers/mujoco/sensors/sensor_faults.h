#pragma once
/// SensorFaults injects faults into encoders, gyro, accelerometer, battery gauge and e-stop button. Each component
/// reports with each kind of fault:
///
///                 encoder of a joint                            gyro, accelerometer
///   off           position and velocity NaN: the drive          not valid (SensorFrame::valid), NaN
///                 works, but has no angle to report
///   stuck         the angle stays, velocity 0                   the sample stays
///   garbage       angle within a turn of the first one,         within the range of a BMI088: ±2000 °/s, ±24 g
///                 velocity within ±kGarbageSpeed, uniform       on each axis, uniform
///   wrong         counts backwards from the first angle,        every axis has the opposite sign
///                 velocity with the opposite sign
///   slow          a sample every 10 cycles, held in between
///   delayed       the sample of 10 cycles ago
///   intermittent  as off, and healthy, at random
///
///                 battery, if there is one                      e-stop button, not pressed
///   off           not valid, NaN                                pressed: its contacts open like a cut wire (ISO 13850)
///   stuck         voltage and current stay                      pressed, jammed
///   garbage       voltage up to twice its value, current        pressed or not, new in every cycle
///                 within ±kGarbageCurrent, uniform
///   wrong         kWrongVoltage times the voltage               pressed
///   slow          a sample every 10 cycles, held in between     not pressed
///   delayed       the sample of 10 cycles ago                   not pressed
///   intermittent  as off, and healthy, at random                pressed and not, at random: a loose wire
///
/// simulation/faults/faulty_output.h defines when a fault acts. Efforts, temperatures and all other values of a frame
/// do not change. Valid samples stay valid with every kind except off, because a device does not detect its own wrong
/// values.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "drivers/mujoco/sensors/sensor_errors.h"
#include "machine/machine_model.h"
#include "signals/sensor_frame.h"
#include "simulation/faults/faulty_output.h"

namespace robot_control {

class SensorFaults {
 public:
  static constexpr double kGarbageSpeed = 100;          ///< rad/s
  static constexpr double kGyroRange = 34.9;            ///< rad/s
  static constexpr double kAccelerometerRange = 235.4;  ///< m/s²
  static constexpr double kGarbageCurrent = 100;        ///< A
  static constexpr double kWrongVoltage = 0.6;  ///< factor; the result is below the voltage of any charged battery

  /// The driven and the held joints of the machine have encoders that fail.
  SensorFaults(const MachineModel& machine, std::uint64_t seed);

  /// Removes all faults.
  void reset() noexcept;

  /// Replaces healthy samples by faulty ones; is called once per cycle. Returns the SensorValidity bits of samples that
  /// are no longer valid. It is real-time safe.
  std::uint64_t step(const InjectedFaults& faults, std::uint64_t cycle, Measurement& measurement) noexcept;

 private:
  struct Reading {
    double position = 0;
    double velocity = 0;
  };
  struct Encoder {
    std::size_t joint = 0;
    FaultyOutput<Reading> output;
  };

  static void step_encoder(Encoder& encoder, FaultKind kind, std::uint64_t cycle, JointSample& joint) noexcept;

  bool failing_ = false;  ///< any component failed in the last step
  std::vector<Encoder> encoders_;
  FaultyOutput<Vector3> gyro_, accelerometer_;
  FaultyOutput<BatterySample> battery_;
  FaultyOutput<bool> button_;
};

}  // namespace robot_control
