#include "safety/conditions/common/body_conditions.h"

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

BodyConditions::BodyConditions(const SafetyParameters& parameters, const MachineModel& machine, const Vector3& point,
                               double period, double force_time, double landing)
    : period_(period),
      weight_(machine.mass * kGravity),
      persistence_(parameters.imu_stuck.persistence),
      landing_(landing),
      tip_tilt_(parameters.tilt.limit.value_or(0) / 2),
      contacts_(std::min(machine.contacts.size(), kMaxContacts)),
      to_base_(rotation_of(machine.imu_in_base.orientation)),
      imu_(Vector(machine.imu_in_base.position.data()) - Vector(point.data())),
      tilt_(kCauseTilt, parameters.tilt, period),
      tip_over_(kCauseTipOver, parameters.tip_over, period),
      free_fall_(kCauseFreeFall, parameters.free_fall, period),
      lift_(kCauseLift, parameters.lift, period),
      impact_(kCauseImpact, parameters.impact, period),
      jump_(kCauseImuJump, parameters.imu_jump, period),
      attitude_(force_time),
      gyro_{.watch{kCauseImuStuck, parameters.imu_stuck, period}},
      accelerometer_{.watch{kCauseImuStuck, parameters.imu_stuck, period}},
      window_(std::clamp<std::size_t>(static_cast<std::size_t>(std::lround(kImpactWindow / period)), 1, kMaxSamples)) {}

void BodyConditions::enter_run() noexcept {
  for (ConditionWatch* watch : {&tilt_, &tip_over_, &free_fall_, &lift_, &impact_, &jump_}) watch->reset();
  for (Repetition* device : {&gyro_, &accelerometer_}) {
    device->watch.reset();
    device->seen = false;
    device->cycles = 0;
  }
  attitude_.reset();
  rate_change_.reset();
  force_ = {};
  across_ = {};
  shock_ = folded_ = 0;
  braked_ = 0;
  carried_ = 1;
}

bool BodyConditions::sample(const SensorFrame& sensors, SensorValidity validity, const Vector3& axes,
                            Eigen::Ref<Eigen::Vector3d> base) const noexcept {
  if ((sensors.valid & validity) == 0 || !finite(axes)) return false;
  base = *to_base_ * Vector(axes.data());
  return true;
}

void BodyConditions::repeat(Repetition& device, bool good, const Vector3& axes, std::uint64_t elapsed, bool moving,
                            ActiveCauses& out) const noexcept {
  const auto bits = std::bit_cast<std::array<std::uint64_t, 3>>(axes);
  const bool same = good && device.seen && device.bits == bits && moving;
  device.cycles = same ? device.cycles + elapsed : 0;
  device.bits = bits;
  device.seen = good;
  const double repeated_s = static_cast<double>(device.cycles) * period_;
  out.update(device.watch, {.beyond = same, .value = repeated_s, .limit = persistence_}, elapsed);
}

void BodyConditions::weigh(const SensorFrame& sensors) noexcept {
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

void BodyConditions::shake(bool felt) noexcept {
  const Eigen::Vector3d up = attitude_.up();
  across_[next_] = {};
  if (felt) *across_[next_] = *force_ - (*force_).dot(up) * up;
  next_ = next_ + 1 == window_ ? 0 : next_ + 1;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < window_; ++i) sum += *across_[i];
  shock_ = sum.norm() / static_cast<double>(window_);
}

void BodyConditions::step(const SensorFrame& sensors, std::uint64_t elapsed, double forward_speed, bool moving,
                          ActiveCauses& out, double least_tilt) noexcept {
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();
  const bool turned = sample(sensors, kValidGyro, sensors.imu.angular_velocity, rate);
  const bool felt = sample(sensors, kValidAccelerometer, sensors.imu.linear_acceleration, *force_);

  const Eigen::Vector3d velocity = forward_speed * Eigen::Vector3d::UnitX() + rate.cross(*imu_);
  const Eigen::Vector3d gravity = *force_ - rate.cross(velocity);
  attitude_.step(turned ? &rate : nullptr, felt ? &gravity : nullptr, static_cast<double>(elapsed) * period_);
  const double tilt = attitude_.tilt();
  const double tilt_rate = attitude_.tilt_rate();
  if (turned) rate_change_.step(sensors.imu.angular_velocity);
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  *rate_ = turned ? rate : Eigen::Vector3d::Constant(kNone);
  along_z_ = felt ? (*force_).z() : kNone;
  shake(felt);
  weigh(sensors);
  braked_ = sensors.gate.verdict == GateVerdict::kBrake ? braked_ + elapsed : 0;
  folded_ = braked_ >= window_ ? 0 : folded_ + static_cast<double>(elapsed) * period_;

  const auto update = [&](ConditionWatch& watch, bool beyond, double value) {
    out.update(watch, {.beyond = beyond, .value = value, .limit = watch.limit()}, elapsed);
  };
  const double tilt_limit = std::max(tilt_.limit(), least_tilt);
  tilt_.step({.beyond = attitude_.known() && tilt > tilt_limit, .value = tilt, .limit = tilt_limit}, elapsed);
  out.add(tilt_);
  update(tip_over_, attitude_.known() && tilt > tip_tilt_ && tilt_rate > tip_over_.limit(), tilt_rate);
  update(free_fall_, felt && force() < free_fall_.limit(), force());
  update(lift_, carried_ < lift_.limit(), carried_);
  update(impact_, folded_ >= landing_ && shock_ > impact_.limit(), shock_);
  update(jump_, turned && rate_change_.value() > jump_.limit(), rate_change_.value());
  repeat(gyro_, turned, sensors.imu.angular_velocity, elapsed, moving, out);
  repeat(accelerometer_, felt, sensors.imu.linear_acceleration, elapsed, moving, out);
}

}  // namespace robot_control
