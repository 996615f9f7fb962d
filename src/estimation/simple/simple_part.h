#pragma once
/// The plain odometer beside the full law, and what it needs to judge that law: bias and rest (rest_bias.h), the pose
/// (planar_track.h), the tilt (tilt.h), and the proof of slip (slip_evidence.h). None of it sees the full law's state.
///
/// Two tracks begin where the full law is while both agree: one some seconds ago, one a minute ago (supervision.h).

#include <array>
#include <optional>

#include "estimation/simple/planar_track.h"
#include "estimation/simple/rest_bias.h"
#include "estimation/simple/slip_evidence.h"
#include "estimation/simple/tilt.h"
#include "estimation/wheels/wheel_geometry.h"

namespace robot_control {

struct SimplePartParams {
  RestBiasParams rest;
  PlanarNoise track;
  SlipEvidenceParams slip;
  Vector3 gyro_bias{};  ///< rad/s, base axes, known from before
};

class SimplePart {
 public:
  static constexpr double kLongestGap = 0.2;  ///< s between gyro samples through which a straight line is drawn

  enum Horizon : std::size_t { kShort, kLong };

  struct Input {
    double dt = 0;                         ///< s
    std::optional<Vector3> gyro;           ///< rad/s, base axes, mean over dt, bias included; empty: lost
    std::optional<double> sample;          ///< rad/s, about z, of the gyro in this step, bias included
    std::optional<Vector3> accelerometer;  ///< m/s², base axes, mean over dt
    std::array<double, 2> travel{};        ///< m, left, right, since that side's last reading
    std::array<bool, 2> received{};        ///< a reading came
    std::array<bool, 2> lost{};
    double speed = 0;  ///< m/s, by the wheels
  };

  SimplePart(const SimplePartParams& params, const WheelGeometry& geometry) noexcept;

  void reset() noexcept;
  void step(const Input& input) noexcept;

  /// Track `horizon` goes on from here.
  void place(Horizon horizon, const PlanarPose& pose, const PlanarCovariance& covariance) noexcept {
    tracks_[horizon].place(pose, covariance, rest_.variance());
  }
  const PlanarTrack& track(Horizon horizon) const noexcept { return tracks_[horizon]; }
  const RestBias& rest() const noexcept { return rest_; }
  const Tilt& tilt() const noexcept { return tilt_; }
  const SlipEvidence& slip() const noexcept { return slip_; }
  /// rad/s, about the vertical, bias removed; without gyro the wheels'.
  double rate() const noexcept { return rate_; }
  bool steady_gravity() const noexcept {
    return rested_force_ >= 3 * RestBias::kWindow;
  }  ///< the tilt is that of a rest

 private:
  void turn(const Input& input) noexcept;
  void roll(const Input& input) noexcept;
  void tilt(const Input& input) noexcept;

  SimplePartParams params_;
  WheelGeometry geometry_;
  RestBias rest_;
  std::array<PlanarTrack, 2> tracks_;
  Tilt tilt_;
  SlipEvidence slip_;
  std::array<double, 2> turned_{};    ///< rad, since that side's last reading
  std::array<double, 2> credited_{};  ///< m, that the other side rolled for a lost one
  double rate_ = 0;
  double last_sample_ = 0;   ///< rad/s
  double silence_ = 0;       ///< s, since a gyro was lost
  double silent_turn_ = 0;   ///< rad, by the wheels since then
  double rested_force_ = 0;  ///< s, of rest with an accelerometer
};

}  // namespace robot_control
