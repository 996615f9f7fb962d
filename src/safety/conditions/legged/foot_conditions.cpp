#include "safety/conditions/legged/foot_conditions.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "machine/gravity.h"

namespace robot_control {
namespace {

std::size_t knee_of(std::size_t leg) noexcept {
  return kLegJoints * leg + kLegJoints - 1;
}

Vector3 plain(const Eigen::Vector3d& vector) noexcept {
  return {vector.x(), vector.y(), vector.z()};
}

Eigen::Vector3d turned(const Eigen::Vector3d& axis, double angle, const Eigen::Vector3d& vector) noexcept {
  return Eigen::AngleAxisd(angle, axis) * vector;
}

}  // namespace

SafetyParameters legged_limits(const SafetyParameters& given, const LegModel& robot) {
  SafetyParameters limits = given;
  if (!limits.foot_slip.limit) limits.foot_slip.limit = robot.leg_length();
  return limits;
}

FootConditions::FootConditions(const SafetyParameters& parameters, const LegModel& robot, double period)
    : weight_(robot.mass * kGravity),
      interval_(
          std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::lround(kWindow / kSamplesInWindow / period)))),
      window_(static_cast<double>(interval_ * kSamplesInWindow) * period),
      slip_(kCauseFootSlip, parameters.foot_slip, period),
      load_(kCauseFootLoad, parameters.foot_load, period),
      worst_(kNothingMeasured) {
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const LegGeometry& given = robot.legs[leg].kinematics.geometry();
    legs_[leg] = {.hip = plain(given.hip),
                  .upper = plain(given.upper),
                  .lower = plain(given.lower),
                  .foot = plain(given.foot),
                  .sign = given.sign};
  }
}

/// The formula is that of leg_kinematics.h.
Eigen::Vector3d FootConditions::position(const Lengths& leg, const LegAngles& angles) noexcept {
  using Map = Eigen::Map<const Eigen::Vector3d>;
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY();
  const Eigen::Vector3d shank = Map(leg.lower.data()) + turned(y, leg.sign[2] * angles[2], Map(leg.foot.data()));
  const Eigen::Vector3d thigh = Map(leg.upper.data()) + turned(y, leg.sign[1] * angles[1], shank);
  return Map(leg.hip.data()) + turned(x, leg.sign[0] * angles[0], thigh);
}

void FootConditions::enter_run() noexcept {
  slip_.reset();
  load_.reset();
  count_ = 0;
  worst_ = kNothingMeasured;
}

void FootConditions::step(const MonitorInput& input, const Eigen::Vector3d& up, std::uint64_t elapsed,
                          ActiveCauses& out) noexcept {
  const SensorFrame& sensors = *input.sensors;
  const bool stands = input.command != nullptr && input.command->legged.phase == LegPhase::kStanding;
  const std::uint64_t lifted = stands ? input.command->legged.lifted : 0;
  if (!stands || lifted != lifted_) {
    count_ = 0;
    worst_ = kNothingMeasured;
  }
  lifted_ = lifted;
  waited_ += elapsed;
  if (stands && (count_ == 0 || waited_ >= interval_)) {
    waited_ = 0;
    sample(sensors, lifted);
  }
  slip_.step(worst_, elapsed);
  out.add(slip_);
  load_.step(stands ? lightest(sensors, up, lifted) : kNothingMeasured, elapsed);
  out.add(load_);
}

void FootConditions::sample(const SensorFrame& sensors, std::uint64_t lifted) noexcept {
  std::array<double, kLegsJoints> angles{};
  for (std::size_t i = 0; i < kLegsJoints; ++i) {
    if (!has_position(sensors.joints[i])) return;
    angles[i] = sensors.joints[i].position;
  }
  std::array<Eigen::Vector3d, kLegs> feet;
  for (std::size_t leg = 0; leg < kLegs; ++leg) feet[leg] = position(legs_[leg], LegModel::angles_of(angles, leg));
  Distances now{};
  std::size_t pair = 0;
  for (std::size_t a = 0; a < kLegs; ++a) {
    for (std::size_t b = a + 1; b < kLegs; ++b) now[pair++] = (feet[a] - feet[b]).norm();
  }
  if (count_ >= kSamplesInWindow) compare(now, lifted);
  samples_[count_ % kSamplesInWindow] = now;
  ++count_;
}

/// The oldest sample is about to be replaced by `now`.
void FootConditions::compare(const Distances& now, std::uint64_t lifted) noexcept {
  const Distances& before = samples_[count_ % kSamplesInWindow];
  std::array<double, kLegs> changes{};
  double largest = 0;
  std::size_t pair = 0;
  for (std::size_t a = 0; a < kLegs; ++a) {
    for (std::size_t b = a + 1; b < kLegs; ++b, ++pair) {
      if (a + 1 == lifted || b + 1 == lifted) continue;
      const double change = std::abs(now[pair] - before[pair]);
      largest = std::max(largest, change);
      changes[a] += change;
      changes[b] += change;
    }
  }
  const auto foot = static_cast<std::size_t>(std::ranges::max_element(changes) - changes.begin());
  worst_ = beyond(knee_of(foot), largest / window_, slip_.limit());
}

ConditionMeasurement FootConditions::lightest(const SensorFrame& sensors, const Eigen::Vector3d& up,
                                              std::uint64_t lifted) const noexcept {
  if (sensors.contact_count < kLegs) return kNothingMeasured;
  const double share = weight_ / static_cast<double>(lifted == 0 ? kLegs : kLegs - 1);
  ConditionMeasurement result{.beyond = false, .value = 1, .limit = load_.limit()};
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const ContactSample& contact = sensors.contacts[leg];
    if (leg + 1 == lifted || contact.valid == 0) continue;
    const double carried = up.dot(Eigen::Map<const Eigen::Vector3d>(contact.force.data())) / share;
    if (carried < result.value) result.value = carried, result.joint = knee_of(leg);
  }
  result.beyond = result.value < result.limit;
  return result;
}

}  // namespace robot_control
