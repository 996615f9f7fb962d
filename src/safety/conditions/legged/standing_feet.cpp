#include "safety/conditions/legged/standing_feet.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "machine/gravity.h"

namespace robot_control {
namespace {

using Vector = Stored<Eigen::Vector3d>;

std::size_t knee_of(std::size_t leg) noexcept {
  return kLegJoints * leg + kLegJoints - 1;
}

Eigen::Vector3d between(const std::array<Vector, kLegs>& feet, std::size_t a, std::size_t b) noexcept {
  return *feet[b] - *feet[a];
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

StandingFeet::StandingFeet(const SafetyParameters& parameters, const LegModel& robot, double period)
    : period_(period),
      weight_(robot.mass * kGravity),
      interval_(
          std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::lround(kWindow / kSamplesInWindow / period)))),
      window_(static_cast<double>(interval_ * kSamplesInWindow) * period),
      slip_limit_(parameters.foot_slip.limit.value_or(0)),
      load_limit_(parameters.foot_load.limit.value_or(0)),
      sinking_limit_(parameters.sinking.limit.value_or(0)),
      turn_limit_(parameters.body_turn.limit.value_or(0)),
      length_(robot.leg_length()) {
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const LegGeometry& given = robot.legs[leg].kinematics.geometry();
    legs_[leg] = {.hip = Vector(given.hip),
                  .upper = Vector(given.upper),
                  .lower = Vector(given.lower),
                  .foot = Vector(given.foot),
                  .sign = given.sign};
  }
}

/// The formula is that of leg_kinematics.h.
Eigen::Vector3d StandingFeet::position(const Lengths& leg, const LegAngles& angles) noexcept {
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY();
  const Eigen::Vector3d shank = *leg.lower + turned(y, leg.sign[2] * angles[2], *leg.foot);
  const Eigen::Vector3d thigh = *leg.upper + turned(y, leg.sign[1] * angles[1], shank);
  return *leg.hip + turned(x, leg.sign[0] * angles[0], thigh);
}

void StandingFeet::enter_run() noexcept {
  counts_ = {};
  loads_.fill(1);
  judged_ = {};
  measured_ = {};
  since_ = {};
  unbraked_ = 0;
  stood_ = false;
  placed_ = bore_ = {};
  uneven_ = 0;
}

FootMeasurements StandingFeet::step(const MonitorInput& input, const BodyMotion& body, std::uint64_t elapsed) noexcept {
  const SensorFrame& sensors = *input.sensors;
  static constexpr CommandFrame kNoCommand;
  const CommandFrame& command = input.command != nullptr ? *input.command : kNoCommand;
  const Eigen::Vector3d up = body.attitude().up();
  const double dt = static_cast<double>(elapsed) * period_;
  const LegPhase phase = command.legged.phase;
  const bool stands = phase == LegPhase::kStanding, walks = phase == LegPhase::kWalking;
  const bool on_feet = stands || walks || phase == LegPhase::kRising || phase == LegPhase::kLowering;
  Feet bears{}, judged{};
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    bears[leg] = walks ? command.contact_schedule[leg] > kEdge : on_feet && leg + 1 != command.legged.lifted;
    judged[leg] = bears[leg] && (stands || walks);
  }
  const bool begins = counts_ == std::array<std::size_t, kLegs>{};
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    if (!judged[leg]) counts_[leg] = 0;
  }
  if (!walks) loads_.fill(1);
  waited_ += elapsed;
  const bool any = judged != Feet{};
  if (!any) measured_.foot_slip = kNothingMeasured;
  if (!any || !walks) measured_.body_turn = kNothingMeasured;
  if (!walks) measured_.sinking = kNothingMeasured;
  unbraked_ = sensors.gate.verdict == GateVerdict::kBrake ? 0 : unbraked_ + dt;
  *since_.turn += dt * body.rate();
  if (!on_feet) placed_ = {};
  ground_.turn(turned_back(body.rate(), dt));
  if (bears != Feet{} && ((any && begins) || waited_ >= interval_)) {
    sample(sensors, command, up, bears, judged, static_cast<double>(waited_) * period_);
    waited_ = 0;
  }
  if (!placed()) ground_ = body.attitude().vertical();
  if (walks && body.pushed()) measured_.foot_slip = measured_.body_turn = kNothingMeasured;
  const double share = weight_ / static_cast<double>(stands && command.legged.lifted != 0 ? kLegs - 1 : kLegs);
  measured_.foot_load = stands || walks ? lightest(sensors, up, judged, share, walks) : kNothingMeasured;
  return measured_;
}

void StandingFeet::sample(const SensorFrame& sensors, const CommandFrame& command, const Eigen::Vector3d& up,
                          const Feet& bears, const Feet& judged, double dt) noexcept {
  std::array<double, kLegsJoints> angles{};
  for (std::size_t i = 0; i < kLegsJoints; ++i) {
    if (!has_position(sensors.joints[i])) return;
    angles[i] = sensors.joints[i].position;
  }
  Sample now = since_;
  since_ = {};
  const Sample& before = samples_[(next_ + kSamplesInWindow - 1) % kSamplesInWindow];
  double height = 0;  // m, of the body above the lowest foot
  bool any = false;
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const Eigen::Vector3d foot = position(legs_[leg], LegModel::angles_of(angles, leg));
    now.feet[leg] = Vector(foot);
    if (!judged[leg]) continue;
    if (counts_[leg] > 0 && ground_.vector().dot(*before.feet[leg] - foot) > kReaching * length_ * dt) counts_[leg] = 0;
    height = std::max(height, -ground_.vector().dot(foot));
    any = true;
  }
  follow_ground(now, bears, command.legged.phase == LegPhase::kWalking, dt);
  if (!any) return;
  height -= command.legged.body[2];
  if (command.legged.phase == LegPhase::kStanding) {
    reference_ = height;
    stood_ = true;
  } else if (stood_) {
    measured_.sinking = beyond(kMaxJoints, (reference_ - height - uneven_) / length_, sinking_limit_);
  }
  compare(now, command, up);
  samples_[next_] = now;
  next_ = (next_ + 1) % kSamplesInWindow;
  for (std::size_t leg = 0; leg < kLegs; ++leg) counts_[leg] += judged[leg] ? 1 : 0;
}

/// The place of a foot that is lifted for long is that in the plane of the others.
void StandingFeet::follow_ground(const Sample& now, const Feet& bears, bool walks, double dt) noexcept {
  const bool known = placed();
  uneven_ *= 1 - std::min(1.0, dt / kUnevenTime);
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const std::size_t beside = leg ^ 1U, behind = leg ^ 2U, across = leg ^ 3U;
    const double beside_plane =
        ground_.vector().dot(*now.feet[leg] - *places_[beside] - *places_[behind] + *places_[across]);
    if (known && walks && bears[leg] && !bore_[leg]) uneven_ = std::max(uneven_, std::abs(beside_plane));
    if (bears[leg]) places_[leg] = now.feet[leg];
    if (!bears[leg] && !walks) places_[leg] = Vector(*now.feet[beside] + *now.feet[behind] - *now.feet[across]);
    placed_[leg] = placed_[leg] || bears[leg] || !walks;
  }
  bore_ = bears;
  const Eigen::Vector3d normal = between(places_, 2, 1).cross(between(places_, 3, 0));
  const bool turns = known && (*now.turn).norm() > kMaxTurn * dt;
  if (placed() && !turns) ground_.pull(normal.normalized(), known ? std::min(1.0, dt / kGroundTime) : 1);
}

/// A foot whose stance ends bears little, and may leave the ground early.
void StandingFeet::compare(const Sample& now, const CommandFrame& command, const Eigen::Vector3d& up) noexcept {
  const bool walks = command.legged.phase == LegPhase::kWalking;
  const auto ago = [&](std::size_t samples) -> const Sample& {
    return samples_[(next_ + kSamplesInWindow - samples) % kSamplesInWindow];
  };
  const auto turn_within = [&](std::size_t samples) {
    Eigen::Vector3d turn = *now.turn;
    for (std::size_t i = 1; i < samples; ++i) turn += *ago(i).turn;
    return turn;
  };
  std::array<double, kLegs> slips{};
  double slip = 0, turn = 0;
  for_each_pair([&](std::size_t a, std::size_t b) {
    const std::size_t samples = std::min({counts_[a], counts_[b], kSamplesInWindow});
    if (samples < kFewestSamples) return;
    const std::size_t later = (samples + 1) / 2;
    const Eigen::Vector3d last = between(now.feet, a, b);
    const auto slides = [&](std::size_t within) {
      const double change = std::abs(last.norm() - between(ago(within).feet, a, b).norm());
      return change * static_cast<double>(samples) / static_cast<double>(within);
    };
    if (samples == kSamplesInWindow) {
      const double along = std::min(slides(samples), slides(later));
      slip = std::max(slip, along);
      slips[a] += along;
      slips[b] += along;
    }
    if (!walks || unbraked_ <= kWindow ||
        std::max(command.contact_schedule[a], command.contact_schedule[b]) > 1 - kEdge)
      return;
    const auto turns = [&](std::size_t within) {
      const Eigen::Vector3d first = between(ago(within).feet, a, b), middle = (first + last) / 2;
      const Eigen::Vector3d change = (last - first + turn_within(within).cross(middle)) * static_cast<double>(samples) /
                                     static_cast<double>(within);
      const double rise = std::abs(change.dot(up)), yaw = std::abs(change.dot(up.cross(middle).normalized()));
      return (std::max(rise, kYawShare * yaw) - kSlipFactor * slides(within) - kUnevenShare * uneven_) / middle.norm();
    };
    turn = std::max(turn, std::min(turns(samples), turns(later)));
  });
  const auto foot = static_cast<std::size_t>(std::ranges::max_element(slips) - slips.begin());
  measured_.foot_slip = beyond(knee_of(foot), slip / window_, (walks ? kStepShare : 1) * slip_limit_);
  measured_.body_turn = beyond(kMaxJoints, turn, turn_limit_);
}

ConditionMeasurement StandingFeet::lightest(const SensorFrame& sensors, const Eigen::Vector3d& up, const Feet& judged,
                                            double share, bool walks) noexcept {
  if (sensors.contact_count < kLegs) return kNothingMeasured;
  ConditionMeasurement result{.beyond = false, .value = 1, .limit = load_limit_};
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
