#include "drivers/mujoco/sensors/sensor_errors.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "drivers/driver.h"

namespace robot_control {
namespace {

// The numbers of the streams; each device has three.
constexpr std::uint64_t kBiasStream = 0;
constexpr std::uint64_t kNoiseStream = 1;
constexpr std::uint64_t kWalkStream = 2;
constexpr std::uint64_t kStreams = 3;
constexpr std::uint64_t kGyroDevice = 0;
constexpr std::uint64_t kAccelerometerDevice = 1;
constexpr std::uint64_t kFirstFootDevice = 4;  // its streams follow ErrorStream
static_assert(kStreams * kFirstFootDevice > kRightSlipStream);

}  // namespace

InertialError::InertialError(double noise, double bias, double walk, double period, std::uint64_t device)
    : noise_(noise / std::sqrt(period)), draw_(bias), walk_(walk * std::sqrt(kWalkCycles * period)), device_(device) {}

void InertialError::reset(std::uint64_t seed) {
  NormalStream bias_stream;
  bias_stream.seed(seed, kStreams * device_ + kBiasStream);
  for (double& axis : bias_) axis = draw_ * bias_stream.next();
  noise_stream_.seed(seed, kStreams * device_ + kNoiseStream);
  walk_stream_.seed(seed, kStreams * device_ + kWalkStream);
  cycle_ = 0;
}

void InertialError::step(Vector3& value) noexcept {
  if (walk_ > 0 && cycle_ > 0 && cycle_ % kWalkCycles == 0) {
    for (double& axis : bias_) axis += walk_ * walk_stream_.next();
  }
  ++cycle_;
  for (std::size_t axis = 0; axis < value.size(); ++axis) value[axis] += bias_[axis];
  if (noise_ > 0) {
    for (double& axis : value) axis += noise_ * noise_stream_.next();
  }
}

namespace {

const ImuDelay& imu_of(const std::vector<Rim>& rims) noexcept {
  return rims.empty() ? kImuOnLegs : kImuOnWheels;
}

}  // namespace

SensorErrors::SensorErrors(const MachineModel& machine, const std::vector<Rim>& rims,
                           const MujocoPlantParameters& parameters, double period)
    : level_(parameters.sensor_errors),
      seed_(parameters.seed),
      period_(period),
      gyro_scale_(1 + parameters.gyro_scale_error),
      gyro_(parameters.gyro_noise, parameters.gyro_bias, parameters.gyro_bias_walk, period, kGyroDevice),
      accelerometer_(parameters.accelerometer_noise, parameters.accelerometer_bias, parameters.accelerometer_bias_walk,
                     period, kAccelerometerDevice),
      threshold_(parameters.foot_threshold),
      joint_offset_(rims.empty() ? parameters.joint_offset : 0),
      vibration_(rims, parameters, period),
      late_imu_(parameters.imu_delay.value_or(imu_of(rims).mean), parameters.imu_jitter.value_or(imu_of(rims).jitter),
                period, kImuLateStream),
      late_encoders_(0, parameters.encoder_jitter, period, kEncodersLateStream),
      delay_(checked_delay("sensor_delay", parameters.sensor_delay)) {
  for (const std::size_t joint : actuated_joint_indices(machine)) {
    const bool held = machine.joints[joint].role == JointRole::kHeld;
    const double counts = machine.joints[joint].prismatic ? 0 : parameters.encoder_resolution * (held ? kHeldGear : 1);
    encoders_.push_back({.joint = joint, .count = counts > 0 ? 2 * std::numbers::pi / counts : 0});
  }
  const bool senses = parameters.contact_sensors && rims.empty();
  const std::size_t feet = senses ? std::min(machine.contacts.size(), kMaxContacts) : 0;
  for (std::size_t foot = 0; foot < feet; ++foot)
    feet_.emplace_back(parameters.foot_noise, parameters.foot_offset, 0, period, kFirstFootDevice + foot);
  reset();
}

void SensorErrors::reset() {
  first_ = true;
  gyro_.reset(seed_);
  accelerometer_.reset(seed_);
  for (InertialError& foot : feet_) foot.reset(seed_);
  vibration_.reset(seed_);
  late_imu_.reset(seed_);
  late_encoders_.reset(seed_);
  NormalStream offsets;
  offsets.seed(seed_, kJointOffsetStream);
  for (Encoder& encoder : encoders_) encoder.offset = joint_offset_ * offsets.next();
}

void SensorErrors::encode(Measurement& measurement) noexcept {
  for (Encoder& encoder : encoders_) {
    if (encoder.count == 0) continue;
    JointSample& joint = measurement.joints[encoder.joint];
    const double counted = std::round((joint.position + encoder.offset) / encoder.count);
    joint.position = counted * encoder.count;
    joint.velocity = first_ ? 0 : (counted - encoder.counted) * encoder.count / period_;
    encoder.counted = counted;
  }
}

/// Delays the samples. Efforts are those of this cycle, because the encoder does not sample them.
void SensorErrors::make_late(Measurement& measurement) noexcept {
  late_imu_.step(measurement.imu);
  if (late_encoders_.on_time()) return;
  Encoders samples{};
  for (std::size_t i = 0; i < encoders_.size(); ++i) samples[i] = measurement.joints[encoders_[i].joint];
  late_encoders_.step(samples);
  for (std::size_t i = 0; i < encoders_.size(); ++i) {
    JointSample& joint = measurement.joints[encoders_[i].joint];
    joint.position = samples[i].position;
    joint.velocity = samples[i].velocity;
  }
}

void SensorErrors::disturb(Measurement& measurement) noexcept {
  if (level_ == ErrorLevel::kField) vibration_.step(measurement);
  for (double& rate : measurement.imu.angular_velocity) rate *= gyro_scale_;
  gyro_.step(measurement.imu.angular_velocity);
  accelerometer_.step(measurement.imu.linear_acceleration);
}

void SensorErrors::weigh(Measurement& measurement) noexcept {
  for (std::size_t foot = 0; foot < feet_.size(); ++foot) {
    Vector3& force = measurement.contacts[foot].force;
    feet_[foot].step(force);
    if (std::hypot(force[0], force[1], force[2]) < threshold_) force = {};
  }
}

void SensorErrors::begin(const Measurement& standing) noexcept {
  for (std::size_t cycle = late_imu_.longest(); cycle > 0; --cycle) {
    Measurement before = standing;
    disturb(before);
    late_imu_.step(before.imu);
  }
}

void SensorErrors::step(Measurement& measurement) noexcept {
  if (level_ == ErrorLevel::kIdeal) return;
  if (first_ && level_ == ErrorLevel::kField) begin(measurement);
  disturb(measurement);
  weigh(measurement);
  encode(measurement);
  if (level_ == ErrorLevel::kField) make_late(measurement);
  if (first_) delay_.fill(measurement);
  delay_.step(measurement);
  first_ = false;
}

std::size_t checked_delay(const char* name, std::uint64_t cycles) {
  if (cycles > kMaxDelay) {
    throw DriverError("mujoco_plant." + std::string(name) + " = " + std::to_string(cycles) + " cycles: at most " +
                      std::to_string(kMaxDelay) + " are possible. Set a smaller delay.");
  }
  return static_cast<std::size_t>(cycles);
}

Vibration::Vibration(std::vector<Rim> rims, const Errors& errors, double period)
    : rims_(std::move(rims)),
      period_(period),
      follow_(1 - std::exp(-2 * std::numbers::pi * kBandwidth * period)),
      gyro_(errors.roughness * errors.gyro_vibration / std::sqrt(period)),
      accelerometer_(errors.roughness * errors.accelerometer_vibration / std::sqrt(period)),
      slow_(errors.roughness * errors.accelerometer_slow_error) {}

void Vibration::reset(std::uint64_t seed) {
  vibration_stream_.seed(seed, kVibrationStream);
  slow_stream_.seed(seed, kSlowErrorStream);
  shaken_gyro_ = shaken_accelerometer_ = {};
  for (double& axis : slow_error_) axis = slow_ * slow_stream_.next();
}

void Vibration::step(Measurement& measurement) noexcept {
  if (rims_.empty()) return;  // a machine without wheels does not roll over a floor
  double speed = 0;
  for (const Rim& rim : rims_) speed += std::abs(measurement.joints[rim.joint].velocity) * rim.radius;
  speed /= static_cast<double>(rims_.size());
  const double kept = std::exp(-speed * period_ / kLength);
  const double renewed = slow_ * std::sqrt(1 - kept * kept);
  for (std::size_t axis = 0; axis < slow_error_.size(); ++axis) {
    shaken_gyro_[axis] += follow_ * (speed * gyro_ * vibration_stream_.next() - shaken_gyro_[axis]);
    double& shaken = shaken_accelerometer_[axis];
    shaken += follow_ * (speed * accelerometer_ * vibration_stream_.next() - shaken);
    slow_error_[axis] = kept * slow_error_[axis] + renewed * slow_stream_.next();
    measurement.imu.angular_velocity[axis] += shaken_gyro_[axis];
    measurement.imu.linear_acceleration[axis] += shaken + slow_error_[axis];
  }
}

}  // namespace robot_control
