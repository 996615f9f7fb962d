#pragma once
/// SensorErrors adds the errors of encoders, gyro and accelerometer to the true values.
///
/// The encoder of a driven joint that turns, with N = encoder_resolution counts per turn, δ = 2π/N, T the period:
///
///   n(k) = round(q(k)/δ)      position = n(k)·δ      velocity = (n(k) − n(k−1))·δ/T
///
/// The velocity is computed as in a drive, in steps of δ/T (1.53 rad/s for 4096 counts at 1 kHz); it is 0 in the first
/// sample. The encoder of a held joint is on its motor, and its gear makes N kHeldGear times larger. With N = 0
/// encoders are exact. Exact are also other joints, contact forces of wheels, battery and inputs, and efforts, because
/// a drive measures its own current.
///
/// The force F on the foot of a robot on legs, base axes, with σ = foot_noise and w, u as below:
///
///   m = F + foot_offset·u + σ/√T·w      measured = m where |m| ≥ foot_threshold, else 0
///
/// Each axis of gyro and accelerometer, with σ = noise, s = walk, and w, v, u independent standard normal numbers:
///
///   measured(k) = (1 + e)·true(k) + b(k) + σ/√T·w(k)      b(k) = b(k−m) + s·√(m·T)·v(k)      b(0) = bias·u
///
/// e is gyro_scale_error; for the accelerometer it is 0.
///
/// The model is white noise of density σ, whose integral over t has the variance σ²·t, and a bias. The bias is drawn at
/// switch-on and walks with the variance s²·t. This is the model of IEEE Std 952, Annex C, without bias instability and
/// quantisation. σ and s are the continuous-time densities of N. Trawny and S. Roumeliotis, "Indirect Kalman Filter for
/// 3D Attitude Estimation", 2005. The bias walks only every m = kWalkCycles cycles, because a step in each cycle would
/// be 4·10⁻⁵ of the noise and double the work.
///
/// In the field a moving robot shakes both devices (vibration.h). The samples of the IMU, and if configured those of
/// the encoders, arrive late and at irregular times (late_samples.h). The IMU has measured the standing robot before a
/// run begins; its samples arrive in the first cycles.
///
/// Finally all samples are delayed together by `sensor_delay` cycles, under the head of the present cycle. In the first
/// cycles the first sample is reported.
///
/// Random numbers depend only on `seed`. Noise, bias and walk of each device have their own streams, so that setting
/// one to zero does not change the others. `reset` restarts all streams with the same bits.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "drivers/mujoco/mujoco_plant_parameters.h"
#include "drivers/mujoco/sensors/late_samples.h"
#include "drivers/mujoco/sensors/measurement.h"
#include "drivers/mujoco/sensors/normal_stream.h"
#include "drivers/mujoco/sensors/vibration.h"
#include "machine/machine_model.h"
#include "simulation/faults/delay_line.h"

namespace robot_control {

inline constexpr double kHeldGear = 100;       ///< strain wave gears of arms have 50 … 160
inline constexpr std::size_t kMaxDelay = 100;  ///< cycles, for sensors and actuators

/// An InertialError adds noise and bias to a device with three axes.
class InertialError {
 public:
  /// The densities are those above, `period` is in s. `device` is a number that differs between devices.
  InertialError(double noise, double bias, double walk, double period, std::uint64_t device);

  static constexpr std::uint64_t kWalkCycles = 10;

  void reset(std::uint64_t seed);
  void step(Vector3& value) noexcept;

  const Vector3& bias() const noexcept { return bias_; }

 private:
  double noise_;  ///< standard deviation of one sample
  double draw_;   ///< standard deviation of the bias at switch-on
  double walk_;   ///< standard deviation of the bias' step in kWalkCycles periods
  std::uint64_t device_;
  std::uint64_t cycle_ = 0;
  Vector3 bias_{};
  NormalStream noise_stream_, walk_stream_;
};

class SensorErrors {
 public:
  /// `rims` are those on which the machine rolls. Throws DriverError for a delay of more than kMaxDelay cycles. At
  /// kIdeal no step changes anything.
  SensorErrors(const MachineModel& machine, const std::vector<Rim>& rims, const MujocoPlantParameters& parameters,
               double period);

  /// Restarts all errors; an ordinary thread calls it.
  void reset();

  /// Replaces the true values by measured ones; is called once per period. It is real-time safe.
  void step(Measurement& measurement) noexcept;

  const InertialError& gyro() const noexcept { return gyro_; }
  const InertialError& accelerometer() const noexcept { return accelerometer_; }

 private:
  void encode(Measurement& measurement) noexcept;
  void disturb(Measurement& measurement) noexcept;   ///< gyro and accelerometer
  void weigh(Measurement& measurement) noexcept;     ///< feet
  void begin(const Measurement& standing) noexcept;  ///< is called before the first cycle
  void make_late(Measurement& measurement) noexcept;

  ErrorLevel level_;
  std::uint64_t seed_;
  double period_;
  struct Encoder {
    std::size_t joint = 0;
    double count = 0;    ///< rad, δ; 0: exact
    double counted = 0;  ///< n in the last sample
  };
  std::vector<Encoder> encoders_;
  bool first_ = true;
  double gyro_scale_;  ///< 1 + e
  InertialError gyro_, accelerometer_;
  std::vector<InertialError> feet_;  ///< of contacts of a machine without rims
  double threshold_;                 ///< N
  Vibration vibration_;
  LateSamples<ImuSample> late_imu_;
  using Encoders = std::array<JointSample, kMaxJoints>;
  LateSamples<Encoders> late_encoders_;
  DelayLine<Measurement, kMaxDelay> delay_;
};

/// Returns a delay of the parameters in cycles. Throws DriverError with its `name` if it is above kMaxDelay.
std::size_t checked_delay(const char* name, std::uint64_t cycles);

}  // namespace robot_control
