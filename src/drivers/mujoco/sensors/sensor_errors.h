#pragma once
/// SensorErrors adds the errors of encoders, gyro and accelerometer to the true values.
///
/// The encoder of a driven joint that turns, with N = encoder_resolution counts per turn, δ = 2π/N, T the period:
///
///   n(k) = round((q(k) + o)/δ)      position = n(k)·δ      velocity = (n(k) − n(k−1))·δ/T
///
/// On legs o = joint_offset·u of each joint, else it is 0. A drive that holds an angle measures with the same encoder,
/// so that its law has the same o. The velocity is computed as in a drive, in steps of δ/T (1.53 rad/s for 4096 counts
/// at 1 kHz); it is 0 in the first sample. The encoder of a held joint is on its motor, and its gear makes N kHeldGear
/// times larger. With N = 0 encoders are exact. Exact are also other joints, contact forces of wheels, battery and
/// inputs, and efforts, because a drive measures its own current.
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
/// In the field a moving robot shakes both devices (Vibration). The samples of the IMU, and if configured those of
/// the encoders, arrive late and at irregular times (LateSamples). The IMU has measured the standing robot before a
/// run begins; its samples arrive in the first cycles.
///
/// Finally all samples are delayed together by `sensor_delay` cycles, under the head of the present cycle. In the first
/// cycles the first sample is reported.
///
/// Random numbers depend only on `seed`. Noise, bias and walk of each device have their own streams, so that setting
/// one to zero does not change the others. `reset` restarts all streams with the same bits.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "drivers/mujoco/mujoco_plant_parameters.h"
#include "drivers/mujoco/sensors/measurement.h"
#include "drivers/mujoco/sensors/normal_stream.h"
#include "machine/machine_model.h"
#include "simulation/faults/delay_line.h"

namespace robot_control {

/// A wheel that rolls on the floor.
struct Rim {
  std::size_t joint = 0;
  double radius = 0;  ///< m
};

/// Vibration adds the vibration of a moving robot to its IMU. With the mean speed v of the drive wheels' rims and the
/// distance s that they have rolled,
///
///   measured = true + r·v·n(t) + r·b(s)
///
/// r  roughness
/// n  accelerometer_vibration, gyro_vibration: noise that is white up to kBandwidth (first order), so that its integral
///    over t has the variance (r v σ)²·t of white noise
/// b  accelerometer_slow_error: the errors of the accelerometer from floor, suspension and scale, an Ornstein–Uhlenbeck
///    process of the correlation length kLength along the path; it is constant while the robot stands
///
/// The axes are independent. The class is real-time safe.
class Vibration {
 public:
  static constexpr double kBandwidth =
      50;                                 ///< Hz; the recordings' IMUs sample at 100 Hz and show no higher frequencies
  static constexpr double kLength = 0.5;  ///< m; in the recordings, slow errors fall to half in 0.5 … 2 s

  /// `period` is in s. Without a rim nothing vibrates.
  Vibration(std::vector<Rim> rims, const Errors& errors, double period);

  void reset(std::uint64_t seed);

  /// Is called once per period with the exact speeds of the wheels.
  void step(Measurement& measurement) noexcept;

 private:
  std::vector<Rim> rims_;
  double period_;
  double follow_;                ///< gain of the low pass per period
  double gyro_, accelerometer_;  ///< standard deviation of a white sample at 1 m/s, r σ/√T
  double slow_;                  ///< m/s², r·accelerometer_slow_error
  NormalStream vibration_stream_, slow_stream_;
  Vector3 shaken_gyro_{}, shaken_accelerometer_{}, slow_error_{};
};

/// LateSamples simulates a device whose samples arrive after a varying delay, as over a serial line or a USB port.
/// Sample i, taken in cycle i, arrives at
///
///   a(i) = max(a(i−1), i·T + delay + |jitter·w(i)|)      w independent standard normal numbers, at most 6
///
/// In cycle k the driver reports the newest sample that has arrived, or the first sample until one has. A sample may be
/// reported in several cycles or in none; their order is kept. The frame's stamp is the time of the cycle, not of the
/// sample, as with a driver that cannot measure the delay. The receiver has to estimate or to tolerate the age of a
/// sample.
///
/// The class holds all samples that have not arrived yet itself and never allocates after construction.
template <class Value>
class LateSamples {
 public:
  /// `delay` ≥ 0, `jitter` ≥ 0 and `period` > 0 are in s.
  LateSamples(double delay, double jitter, double period, ErrorStream stream)
      : delay_(delay / period), jitter_(jitter / period), stream_(stream), on_the_way_(longest() + 2) {}

  void reset(std::uint64_t seed) {
    random_.seed(seed, stream_);
    cycle_ = sent_ = arrived_ = 0;
    last_arrival_ = 0;
  }

  /// Returns true if no sample is late.
  bool on_time() const noexcept { return delay_ == 0 && jitter_ == 0; }

  /// Returns after how many cycles every sample has arrived; 0 if all are on time.
  std::size_t longest() const noexcept {
    return on_time() ? 0 : static_cast<std::size_t>(std::ceil(delay_ + kMaxDeviations * jitter_));
  }

  /// Replaces the sample of this cycle by the one that the driver reports.
  void step(Value& value) noexcept {
    if (on_time()) return;
    if (cycle_ == 0) reported_ = value;
    const auto now = static_cast<double>(cycle_++);
    const double late = jitter_ > 0 ? jitter_ * std::min(kMaxDeviations, std::abs(random_.next())) : 0;
    last_arrival_ = std::max(last_arrival_, now + delay_ + late);
    on_the_way_[sent_++ % on_the_way_.size()] = {value, last_arrival_};
    while (arrived_ < sent_) {
      const Sample& next = on_the_way_[arrived_ % on_the_way_.size()];
      if (next.arrival > now + kSameTime) break;
      reported_ = next.value;
      ++arrived_;
    }
    value = reported_;
  }

 private:
  static constexpr double kMaxDeviations = 6;  ///< standard deviations
  static constexpr double kSameTime = 1e-6;    ///< cycles

  struct Sample {
    Value value{};
    double arrival = 0;  ///< cycles
  };

  double delay_, jitter_;  ///< cycles
  ErrorStream stream_;
  NormalStream random_;
  std::uint64_t cycle_ = 0, sent_ = 0, arrived_ = 0;
  double last_arrival_ = 0;
  Value reported_{};
  std::vector<Sample> on_the_way_;
};

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

  /// Returns o in rad of a joint with a motor, in the order of actuated_joint_indices.
  double zero_error(std::size_t drive) const noexcept {
    return encoders_[drive].count > 0 ? encoders_[drive].offset : 0;
  }

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
    double offset = 0;   ///< rad
    double counted = 0;  ///< n in the last sample
  };
  std::vector<Encoder> encoders_;
  bool first_ = true;
  double gyro_scale_;  ///< 1 + e
  InertialError gyro_, accelerometer_;
  std::vector<InertialError> feet_;  ///< of contacts of a machine without rims
  double threshold_;                 ///< N
  double joint_offset_;              ///< rad
  Vibration vibration_;
  LateSamples<ImuSample> late_imu_;
  using Encoders = std::array<JointSample, kMaxJoints>;
  LateSamples<Encoders> late_encoders_;
  DelayLine<Measurement, kMaxDelay> delay_;
};

/// Returns a delay of the parameters in cycles. Throws DriverError with its `name` if it is above kMaxDelay.
std::size_t checked_delay(const char* name, std::uint64_t cycles);

}  // namespace robot_control
