#include "safety/measurements/body_motion.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "machine/gravity.h"
#include "signals/rotation.h"

namespace robot_control {
namespace {

using Vector = Eigen::Map<const Eigen::Vector3d>;

}  // namespace

BodyMotion::BodyMotion(const MachineModel& machine, const Vector3& point, double period, double force_time,
                       double landing)
    : period_(period),
      weight_(machine.mass * kGravity),
      landing_(landing),
      contacts_(std::min(machine.contacts.size(), kMaxContacts)),
      to_base_(rotation_of(machine.imu_in_base.orientation)),
      imu_(Vector(machine.imu_in_base.position.data()) - Vector(point.data())),
      attitude_(force_time),
      window_(std::clamp<std::size_t>(static_cast<std::size_t>(std::lround(kImpactWindow / period)), 1, kMaxSamples)) {}

void BodyMotion::enter_run() noexcept {
  gyro_ = accelerometer_ = {};
  attitude_.reset();
  rate_change_.reset();
  force_ = {};
  across_ = {};
  shock_ = push_ = folded_ = 0;
  unpushed_ = std::numeric_limits<double>::infinity();
  braked_ = 0;
  carried_ = 1;
}

bool BodyMotion::sample(const SensorFrame& sensors, SensorValidity validity, const Vector3& axes,
                        Eigen::Ref<Eigen::Vector3d> base) const noexcept {
  if ((sensors.valid & validity) == 0 || !finite(axes)) return false;
  base = *to_base_ * Vector(axes.data());
  return true;
}

void BodyMotion::repeat(Repetition& device, bool good, const Vector3& axes, std::uint64_t elapsed,
                        bool moving) const noexcept {
  const auto bits = std::bit_cast<std::array<std::uint64_t, 3>>(axes);
  const bool same = good && device.seen && device.bits == bits && moving;
  const std::uint64_t cycles = same ? device.cycles + elapsed : 0;
  device = {bits, good, cycles, static_cast<double>(cycles) * period_};
}

void BodyMotion::weigh(const SensorFrame& sensors) noexcept {
  carried_ = 1;
  const std::size_t sensed = std::min<std::size_t>(contacts_, sensors.contact_count);
  if (sensed == 0) return;
  double sum = 0;
  for (std::size_t i = 0; i < sensed; ++i) {
    const ContactSample& contact = sensors.contacts[i];
    if (contact.valid == 0) return;
    sum += attitude_.up().dot(Vector(contact.force.data()));
  }
  if (std::isfinite(sum)) carried_ = sum / weight_;
}

void BodyMotion::shake(double dt) noexcept {
  const Eigen::Vector3d up = attitude_.up();
  across_[next_] = {};
  if (felt_) *across_[next_] = *force_ - (*force_).dot(up) * up;
  next_ = next_ + 1 == window_ ? 0 : next_ + 1;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < window_; ++i) sum += *across_[i];
  shock_ = sum.norm() / static_cast<double>(window_);
  push_ += std::min(1.0, dt / kPushTime) * (shock_ - push_);
  unpushed_ = push_ > kGravity ? 0 : unpushed_ + dt;
}

void BodyMotion::step(const SensorFrame& sensors, std::uint64_t elapsed, double forward_speed, bool moving) noexcept {
  const double dt = static_cast<double>(elapsed) * period_;
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();
  turned_ = sample(sensors, kValidGyro, sensors.imu.angular_velocity, rate);
  felt_ = sample(sensors, kValidAccelerometer, sensors.imu.linear_acceleration, *force_);

  const Eigen::Vector3d velocity = forward_speed * Eigen::Vector3d::UnitX() + rate.cross(*imu_);
  const Eigen::Vector3d gravity = *force_ - rate.cross(velocity);
  attitude_.step(turned_ ? &rate : nullptr, felt_ ? &gravity : nullptr, dt);
  if (turned_) rate_change_.step(sensors.imu.angular_velocity);
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  *rate_ = turned_ ? rate : Eigen::Vector3d::Constant(kNone);
  along_z_ = felt_ ? (*force_).z() : kNone;
  shake(dt);
  weigh(sensors);
  braked_ = sensors.gate.verdict == GateVerdict::kBrake ? braked_ + elapsed : 0;
  folded_ = braked_ >= window_ ? 0 : folded_ + dt;
  repeat(gyro_, turned_, sensors.imu.angular_velocity, elapsed, moving);
  repeat(accelerometer_, felt_, sensors.imu.linear_acceleration, elapsed, moving);
}

}  // namespace robot_control
