#pragma once
/// Which law is published. The full law is compared with the simple part (simple_part.h), whose two tracks began where
/// the full law was kShortHorizon and kLongHorizon seconds ago at most. They disagree where
///
///   the position is further apart than kSigmas σ + kCreep path + kPositionSlack, for kPatience
///   the heading is further apart than kSigmas σ + kHeadingSlack, for kPatience
///   the speed is more than kRestSpeed at the end of a window of rest
///   the speed is outside of zero, the wheels' and what these were, slowed by kSlideDeceleration, by kSpeedSlack, for
///   kSpeedTime; or it is larger sideways
///   the tilt is further apart than kTiltSlack at rest
///
/// σ is what the simple part's own errors have grown by since its track began. Then, if no slip is proven
/// (slip_evidence.h), the simple part wins, from where both agreed last. The full law begins again from the simple
/// part's pose, and is published again once it has agreed, without a slip that is not proven, for a probation, which
/// doubles each time. While slip is proven, and as long as the full law follows it up, at most kSlide, the simple part
/// follows the full law; not where the residuals show that the accelerometer errs by more than its noise.

#include <cstdint>

#include "estimation/simple/simple_part.h"

namespace robot_control {

/// What the full law says.
struct FullEstimate {
  PlanarPose pose;                   ///< middle of the wheels
  PlanarCovariance covariance;       ///< of the pose
  double forward = 0, sideways = 0;  ///< m/s
  Vector3 up{0, 0, 1};
  bool holds = false;  ///< it takes the robot for one at rest, and looks whether it is
  bool slips = false;  ///< it does not trust a contact
};

class Supervision {
 public:
  static constexpr double kShortHorizon = 2.0;  ///< s
  static constexpr double kLongHorizon = 60.0;  ///< s
  static constexpr double kSigmas = 4;
  static constexpr double kCreep = 0.005;            ///< of the way: a tyre on a slope of 10°
  static constexpr double kPositionSlack = 0.02;     ///< m
  static constexpr double kHeadingSlack = 0.01;      ///< rad
  static constexpr double kSpeedSlack = 0.05;        ///< m/s
  static constexpr double kSlideDeceleration = 1.0;  ///< m/s², of wheels on a slippery floor at most
  static constexpr double kSpeedTime = 0.2;          ///< s, for which the speed must be wrong
  static constexpr double kPatience = 0.5;     ///< s, for which way and heading must be: proof of slip takes as long
  static constexpr double kRestSpeed = 0.005;  ///< m/s
  static constexpr double kTiltSlack = 0.06;   ///< sine; an accelerometer's bias of 0.2 m/s², three times
  static constexpr double kProbation = 20.0;   ///< s, the first time
  static constexpr double kLongestProbation = 320.0;  ///< s
  static constexpr double kSlide = 12.0;              ///< s; the full law trusts the wheels again after 10
  static constexpr double kFirstSlide = 1.0;          ///< s, while the level of the residuals is not known
  static constexpr double kFollowed = 3;              ///< residual level up to which a proven slip is followed
  static constexpr double kCalm = 5;    ///< vibration up to which an unproven one is: recorded robots show 20 … 50
  static constexpr double kClaims = 6;  ///< s of unproven slip that a calm robot may claim
  static constexpr double kClaimShare = 0.15;  ///< of the time, likewise

  enum class Verdict {
    kKeep,    ///< as before
    kRenew,   ///< the full law begins again at the simple part's pose: that of track kLong
    kAccept,  ///< the full law is published again, placed at the simple part's pose
  };

  void reset() noexcept { *this = Supervision(); }

  /// May place the tracks of `simple`.
  Verdict step(const FullEstimate& full, SimplePart& simple, double wheel_speed, double dt) noexcept;

  std::uint64_t reasons() const noexcept { return reasons_; }  ///< DegradedReason bits
  bool degraded() const noexcept { return reasons_ != 0; }

 private:
  static std::uint64_t apart(const FullEstimate& full, const PlanarTrack& track) noexcept;
  std::uint64_t contradictions(const FullEstimate& full, const SimplePart& simple, double dt) noexcept;
  void follow(const FullEstimate& full, SimplePart& simple, double dt) noexcept;

  std::uint64_t reasons_ = 0;
  double probation_ = kProbation;  ///< s, of the next
  double agreed_ = 0;              ///< s
  double short_age_ = 0, long_age_ = 0;
  double least_ = 0, most_ = 0;  ///< m/s, between which the wheels were, or a robot that slides since
  double too_fast_ = 0;          ///< s
  double apart_ = 0;             ///< s
  bool sliding_ = false;         ///< slip was proven, and the full law has not seen its end
  bool calm_ = false;            ///< before the full law saw slip, its sensors were as good as it takes them for
  double claimed_ = 0;           ///< s
};

}  // namespace robot_control
