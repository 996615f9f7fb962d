#include "estimation/simple/supervision.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "signals/state_frame.h"

namespace robot_control {

std::uint64_t Supervision::apart(const FullEstimate& full, const PlanarTrack& track) noexcept {
  std::uint64_t reasons = 0;
  const double way = std::hypot(full.pose.x - track.pose().x, full.pose.y - track.pose().y);
  const double position = kSigmas * std::sqrt(std::max(0.0, track.position_growth()));
  if (!(way <= position + kCreep * track.path() + kPositionSlack)) reasons |= kDegradedPosition;
  const double turn = std::abs(std::remainder(full.pose.yaw - track.pose().yaw, 2 * std::numbers::pi));
  const double heading = kSigmas * std::sqrt(std::max(0.0, track.yaw_growth()));
  if (!(turn <= heading + kHeadingSlack)) reasons |= kDegradedHeading;
  return reasons;
}

std::uint64_t Supervision::contradictions(const FullEstimate& full, const SimplePart& simple, double dt) noexcept {
  std::uint64_t reasons = 0;
  const double speed = std::hypot(full.forward, full.sideways);
  const double least = least_ - kSpeedSlack;
  const double most = most_ + kSpeedSlack;
  const bool along = full.forward >= least && full.forward <= most;
  const bool across = std::abs(full.sideways) <= std::max(-least, most);
  too_fast_ = along && across ? 0 : too_fast_ + dt;
  if (too_fast_ > kSpeedTime) reasons |= kDegradedSpeed;
  const bool rests = simple.rest().window_ended() && simple.rest().rested() >= 2 * RestBias::kWindow &&
                     simple.slip().since_proof() > kSlide;
  if (rests && !(speed <= kRestSpeed)) reasons |= kDegradedSpeed;
  const double tilted = std::hypot(full.up[0] - simple.tilt().up()[0], full.up[1] - simple.tilt().up()[1]);
  if (simple.steady_gravity() && !(tilted <= kTiltSlack)) reasons |= kDegradedTilt;
  std::uint64_t away = sliding_ || full.holds ? 0 : apart(full, simple.track(SimplePart::kShort));
  if (!(sliding_ || full.holds) && !degraded()) away |= apart(full, simple.track(SimplePart::kLong));
  apart_ = away == 0 ? 0 : apart_ + dt;
  return apart_ > kPatience ? reasons | away : reasons;
}

void Supervision::follow(const FullEstimate& full, SimplePart& simple, double dt) noexcept {
  short_age_ += dt;
  long_age_ += dt;
  if (apart_ > 0) return;
  const auto begin_anew = [&](SimplePart::Horizon horizon) {  // what agrees is known as well as the better knows it
    const PlanarCovariance& own = simple.track(horizon).covariance();
    const bool better = !sliding_ && own.xx + own.yy < full.covariance.xx + full.covariance.yy;
    simple.place(horizon, full.pose, better ? own : full.covariance);
  };
  if (sliding_ || short_age_ >= kShortHorizon) begin_anew(SimplePart::kShort);
  if (sliding_ || long_age_ >= kLongHorizon) begin_anew(SimplePart::kLong);
  if (sliding_ || short_age_ >= kShortHorizon) short_age_ = 0;
  if (sliding_ || long_age_ >= kLongHorizon) long_age_ = 0;
}

Supervision::Verdict Supervision::step(const FullEstimate& full, SimplePart& simple, double wheel_speed,
                                       double dt) noexcept {
  const bool proven = simple.slip().proven();
  const double level = simple.slip().level();
  const double followed = level == 0 ? kFirstSlide : level < kFollowed ? kSlide : 0;
  if (!full.slips) calm_ = level > 0 && simple.slip().vibration() < kCalm;
  const bool claims = full.slips && calm_ && claimed_ < kClaims;
  claimed_ = std::max(0.0, claimed_ + (claims && !proven ? dt : -kClaimShare * dt));
  sliding_ = claims || (followed > 0 && (proven || (sliding_ && full.slips)) && simple.slip().since_proof() < followed);
  const double slower = sliding_ ? 0 : kSlideDeceleration * dt;
  least_ = std::min({0.0, wheel_speed, least_ + slower});
  most_ = std::max({0.0, wheel_speed, most_ - slower});
  if (degraded()) sliding_ = false;
  const std::uint64_t reasons = contradictions(full, simple, dt);
  if (reasons != 0) {
    const auto copy = [&](SimplePart::Horizon to, SimplePart::Horizon from) {
      simple.place(to, simple.track(from).pose(), simple.track(from).covariance());
    };
    const bool long_agrees = apart(full, simple.track(SimplePart::kLong)) == 0;
    if (!degraded() && long_agrees) copy(SimplePart::kLong, SimplePart::kShort);
    copy(SimplePart::kShort, SimplePart::kLong);
    if (degraded() && agreed_ > 0) probation_ = std::min(2 * probation_, kLongestProbation);
    reasons_ |= reasons;
    agreed_ = too_fast_ = apart_ = 0;
    return Verdict::kRenew;
  }
  if (!degraded()) {
    follow(full, simple, dt);
    return Verdict::kKeep;
  }
  agreed_ = full.slips && !proven ? 0 : agreed_ + dt;
  if (agreed_ < probation_) return Verdict::kKeep;
  probation_ = std::min(2 * probation_, kLongestProbation);
  reasons_ = 0;
  agreed_ = 0;
  short_age_ = long_age_ = 0;
  simple.place(SimplePart::kShort, simple.track(SimplePart::kLong).pose(),
               simple.track(SimplePart::kLong).covariance());
  return Verdict::kAccept;
}

}  // namespace robot_control
