#include "safety/conditions/legged/foot_conditions.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "machine/gravity.h"

namespace robot_control {
namespace {

using Map = Eigen::Map<Eigen::Vector3d>;
using ConstMap = Eigen::Map<const Eigen::Vector3d>;

std::size_t knee_of(std::size_t leg) noexcept {
  return kLegJoints * leg + kLegJoints - 1;
}

Vector3 plain(const Eigen::Vector3d& vector) noexcept {
  return {vector.x(), vector.y(), vector.z()};
}

Eigen::Vector3d between(const std::array<Vector3, kLegs>& feet, std::size_t a, std::size_t b) noexcept {
  return ConstMap(feet[b].data()) - ConstMap(feet[a].data());
}

template <class Each>
void for_each_pair(const Each& each) noexcept {
  for (std::size_t a = 0; a < kLegs; ++a) {
    for (std::size_t b = a + 1; b < kLegs; ++b) each(a, b);
  }
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
      period_(period),
      interval_(
          std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::lround(kWindow / kSamplesInWindow / period)))),
      window_(static_cast<double>(interval_ * kSamplesInWindow) * period),
      slip_(kCauseFootSlip, parameters.foot_slip, period),
      load_(kCauseFootLoad, parameters.foot_load, period),
      sinking_(kCauseSinking, parameters.sinking, period),
      turning_(kCauseBodyTurn, parameters.body_turn, period),
      length_(robot.leg_length()),
      slipped_(kNothingMeasured),
      sunk_(kNothingMeasured),
      turned_(kNothingMeasured) {
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
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY();
  const Eigen::Vector3d shank =
      ConstMap(leg.lower.data()) + turned(y, leg.sign[2] * angles[2], ConstMap(leg.foot.data()));
  const Eigen::Vector3d thigh = ConstMap(leg.upper.data()) + turned(y, leg.sign[1] * angles[1], shank);
  return ConstMap(leg.hip.data()) + turned(x, leg.sign[0] * angles[0], thigh);
}

void FootConditions::enter_run() noexcept {
  for (ConditionWatch* watch : {&slip_, &load_, &sinking_, &turning_}) watch->reset();
  counts_ = {};
  loads_.fill(1);
  judged_ = {};
  slipped_ = sunk_ = turned_ = kNothingMeasured;
  since_ = {};
  unbraked_ = 0;
  stood_ = false;
}

void FootConditions::step(const MonitorInput& input, const Eigen::Vector3d& up, const Eigen::Vector3d& rate,
                          std::uint64_t elapsed, ActiveCauses& out) noexcept {
  const LeggedCommand asked = input.command != nullptr ? input.command->legged : LeggedCommand{};
  const bool stands = asked.phase == LegPhase::kStanding, walks = asked.phase == LegPhase::kWalking;
  Feet judged{};
  for (std::size_t leg = 0; leg < kLegs; ++leg)
    judged[leg] = stands ? leg + 1 != asked.lifted : walks && asked.stance[leg] > kEdge;
  const bool begins = counts_ == std::array<std::size_t, kLegs>{};
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    if (!judged[leg]) counts_[leg] = 0;
  }
  if (!walks) loads_.fill(1);
  waited_ += elapsed;
  const bool any = judged != Feet{};
  if (!any) slipped_ = turned_ = kNothingMeasured;
  if (!walks) sunk_ = turned_ = kNothingMeasured;
  const double time = static_cast<double>(elapsed) * period_;
  unbraked_ = input.sensors->gate.verdict == GateVerdict::kBrake ? 0 : unbraked_ + time;
  Map(since_.turn.data()) += time * rate;
  if (any && (begins || waited_ >= interval_)) {
    waited_ = 0;
    sample(*input.sensors, asked, up, judged);
  }
  out.update(slip_, slipped_, elapsed);
  const double share = weight_ / static_cast<double>(stands && asked.lifted != 0 ? kLegs - 1 : kLegs);
  out.update(load_, stands || walks ? lightest(*input.sensors, up, judged, share, walks) : kNothingMeasured, elapsed);
  out.update(sinking_, sunk_, elapsed);
  out.update(turning_, turned_, elapsed);
}

void FootConditions::sample(const SensorFrame& sensors, const LeggedCommand& asked, const Eigen::Vector3d& up,
                            const Feet& judged) noexcept {
  LegsValues angles{};
  for (std::size_t i = 0; i < kLegsJoints; ++i) {
    if (!has_position(sensors.joints[i])) return;
    angles[i] = sensors.joints[i].position;
  }
  Sample now = since_;
  since_ = {};
  double height = 0, count = 0;
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const Eigen::Vector3d foot = position(legs_[leg], LegModel::angles_of(angles, leg));
    now.feet[leg] = plain(foot);
    if (!judged[leg]) continue;
    height -= up.dot(foot);
    ++count;
  }
  height = height / count - asked.body[2];
  if (asked.phase == LegPhase::kStanding) {
    reference_ = height;
    stood_ = true;
  } else if (stood_) {
    sunk_ = beyond(kMaxJoints, (reference_ - height) / length_, sinking_.limit());
  }
  compare(now, asked, up);
  samples_[next_] = now;
  next_ = (next_ + 1) % kSamplesInWindow;
  for (std::size_t leg = 0; leg < kLegs; ++leg) counts_[leg] += judged[leg] ? 1 : 0;
}

/// A foot whose stance ends bears little, and may leave the ground early.
void FootConditions::compare(const Sample& now, const LeggedCommand& asked, const Eigen::Vector3d& up) noexcept {
  const bool walks = asked.phase == LegPhase::kWalking;
  const auto ago = [&](std::size_t samples) -> const Sample& {
    return samples_[(next_ + kSamplesInWindow - samples) % kSamplesInWindow];
  };
  const auto turn_within = [&](std::size_t samples) {
    Eigen::Vector3d turn = ConstMap(now.turn.data());
    for (std::size_t i = 1; i < samples; ++i) turn += ConstMap(ago(i).turn.data());
    return turn;
  };
  std::array<double, kLegs> slips{};
  double slip = 0, turn = 0;
  for_each_pair([&](std::size_t a, std::size_t b) {
    const std::size_t samples = std::min({counts_[a], counts_[b], kSamplesInWindow});
    if (samples < kFewestSamples) return;
    const Eigen::Vector3d first = between(ago(samples).feet, a, b), last = between(now.feet, a, b);
    const double along = std::abs(last.norm() - first.norm());
    if (samples == kSamplesInWindow) {
      slip = std::max(slip, along);
      slips[a] += along;
      slips[b] += along;
    }
    if (!walks || unbraked_ <= kWindow || std::max(asked.stance[a], asked.stance[b]) > 1 - kEdge) return;
    const Eigen::Vector3d middle = (first + last) / 2, change = last - first + turn_within(samples).cross(middle);
    const double rise = std::abs(change.dot(up)), yaw = std::abs(change.dot(up.cross(middle).normalized()));
    turn = std::max(turn, (std::max(rise, kOfYaw * yaw) - kOfSlip * along) / middle.norm());
  });
  const auto foot = static_cast<std::size_t>(std::ranges::max_element(slips) - slips.begin());
  slipped_ = beyond(knee_of(foot), slip / window_, (walks ? kOfStep : 1) * slip_.limit());
  turned_ = beyond(kMaxJoints, turn, turning_.limit());
}

ConditionMeasurement FootConditions::lightest(const SensorFrame& sensors, const Eigen::Vector3d& up, const Feet& judged,
                                              double share, bool walks) noexcept {
  if (sensors.contact_count < kLegs) return kNothingMeasured;
  ConditionMeasurement result{.beyond = false, .value = 1, .limit = load_.limit()};
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const ContactSample& contact = sensors.contacts[leg];
    if (judged[leg]) {
      const double load =
          contact.valid != 0 ? up.dot(Eigen::Map<const Eigen::Vector3d>(contact.force.data())) / share : 1;
      loads_[leg] = walks && judged_[leg] ? std::max(loads_[leg], load) : load;
    }
    if (loads_[leg] < result.value) result.value = loads_[leg], result.joint = knee_of(leg);
  }
  judged_ = judged;
  result.beyond = result.value < result.limit;
  return result;
}

}  // namespace robot_control
