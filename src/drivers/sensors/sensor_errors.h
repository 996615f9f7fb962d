#pragma once
/// What encoders, gyro and accelerometer report instead of the truth.
///
/// Encoder of a wheel with N = encoder_resolution counts per turn, δ = 2π/N, T the period:
///
///   n(k) = round(q(k)/δ)      position = n(k)·δ      velocity = (n(k) − n(k−1))·δ/T
///
/// the velocity as a drive derives it, in steps of δ/T (1.53 rad/s for 4096 counts at 1 kHz); 0 in the first sample.
/// N = 0: exact. Joints that are no wheels are exact, and so are contact forces, battery and inputs, and efforts: a
/// drive measures its own current.
///
/// Gyro and accelerometer, each axis, with σ = noise, s = walk, and w, v, u independent standard normal numbers:
///
///   measured(k) = (1 + e)·true(k) + b(k) + σ/√T·w(k)      b(k) = b(k−m) + s·√(m·T)·v(k)      b(0) = bias·u
///
/// with e = gyro_scale_error, 0 of the accelerometer.
///
/// White noise of density σ, so that its integral over t has the variance σ²·t, on a bias that is drawn at switch-on
/// and walks with the variance s²·t (the model of IEEE Std 952, Annex C, without its terms of bias instability and
/// quantisation; σ and s are the continuous-time densities of N. Trawny and S. Roumeliotis, "Indirect Kalman Filter
/// for 3D Attitude Estimation", 2005). It walks every m = kWalkCycles cycles: a step in each of them would be 4·10⁻⁵ of
/// the noise and twice the work.
///
/// In the field a moving robot shakes both (vibration.h), and the samples of the IMU, of the encoders where asked for,
/// arrive late and at irregular times (late_samples.h). The IMU has measured the standing robot before a run begins, so
/// that what arrives in the first cycles are samples of that time.
///
/// Then all samples are `sensor_delay` cycles late together, under the head of the present cycle; until there is one
/// so old, the first one comes.
///
/// Random numbers come from `seed` alone. Noise, bias and walk of each device are streams of their own: one that is
/// set to zero changes none of the others. `reset` restarts all of them, with the same bits.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "drivers/mujoco_plant_parameters.h"
#include "drivers/sensors/late_samples.h"
#include "drivers/sensors/measurement.h"
#include "drivers/sensors/normal_stream.h"
#include "drivers/sensors/vibration.h"
#include "faults/delay_line.h"
#include "robot/robot_model.h"

namespace robot_control {

inline constexpr std::size_t kMaxDelay = 100;  ///< cycles, of sensors as of actuators

/// The noise and the bias of a device with three axes.
class InertialError {
 public:
  /// Densities as above; `period` in s. `device`: another number for each.
  InertialError(double noise, double bias, double walk, double period, std::uint64_t device);

  static constexpr std::uint64_t kWalkCycles = 10;

  void reset(std::uint64_t seed);
  void step(Vector3& value) noexcept;

  const Vector3& bias() const noexcept { return bias_; }

 private:
  double noise_;  ///< standard deviation of one sample
  double draw_;   ///< of the bias at switch-on
  double walk_;   ///< of the bias' step in kWalkCycles periods
  std::uint64_t device_;
  std::uint64_t cycle_ = 0;
  Vector3 bias_{};
  NormalStream noise_stream_, walk_stream_;
};

class SensorErrors {
 public:
  /// Throws DriverError: a delay of more than kMaxDelay cycles. At kIdeal all steps change nothing.
  SensorErrors(const RobotModel& robot, const MujocoPlantParameters& parameters, double period);

  /// Ordinary thread: restarts.
  void reset();

  /// Once per period: truth in, what is measured in its place. Real-time safe.
  void step(Measurement& measurement) noexcept;

  const InertialError& gyro() const noexcept { return gyro_; }
  const InertialError& accelerometer() const noexcept { return accelerometer_; }

 private:
  void encode(Measurement& measurement) noexcept;
  void disturb(Measurement& measurement) noexcept;   ///< gyro and accelerometer
  void begin(const Measurement& standing) noexcept;  ///< before the first cycle
  void make_late(Measurement& measurement) noexcept;

  ErrorLevel level_;
  std::uint64_t seed_;
  double period_;
  double count_;  ///< rad, δ; 0: exact
  std::vector<std::size_t> wheels_;
  std::array<double, kMaxWheels> counted_{};  ///< n of the last sample
  bool first_ = true;
  double gyro_scale_;  ///< 1 + e
  InertialError gyro_, accelerometer_;
  Vibration vibration_;
  LateSamples<ImuSample> late_imu_;
  using Encoders = std::array<JointSample, kMaxWheels>;
  LateSamples<Encoders> late_encoders_;
  DelayLine<Measurement, kMaxDelay> delay_;
};

/// A delay in cycles out of the parameters; throws DriverError naming it where it is above kMaxDelay.
std::size_t checked_delay(const char* name, std::uint64_t cycles);

}  // namespace robot_control
