// The estimator's simple part: what it is given, and what follows from its comparison with the full law.

#include <cmath>

#include "estimation/estimator.h"
#include "estimation/filter/algebra.h"
#include "estimation/filter/placing.h"

namespace robot_control {
namespace {

using namespace algebra;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using Filter = ErrorStateFilter;

constexpr int kPlanarAxes[3] = {Filter::kPosition, Filter::kPosition + 1, Filter::kOrientation + 2};

}  // namespace

void Estimator::follow_simply(double dt) noexcept {
  SimplePart::Input input;
  input.dt = dt;
  input.speed = wheel_speed();
  if (imu_.gyro()) input.gyro = array(*imu_.gyro());
  if (imu_.new_gyro()) input.sample = imu_.last_gyro().z();
  if (imu_.accelerometer()) input.accelerometer = array(*imu_.accelerometer());
  for (const int i : {kLeft, kRight}) {
    const auto side = static_cast<std::size_t>(i);
    input.travel[side] = sides_[side].encoder.travel();
    input.received[side] = sides_[side].encoder.received();
    input.lost[side] = lost(i);
  }
  simple_.step(input);
}

void Estimator::supervise(double dt) noexcept {
  const bool was = supervision_.degraded();
  const auto verdict = supervision_.step(full_estimate(), simple_, wheel_speed(), dt);
  if (verdict == Supervision::Verdict::kRenew) renew();
  if (verdict == Supervision::Verdict::kAccept) accept();
  if (was != supervision_.degraded()) rate_follows_ = false;
}

FullEstimate Estimator::full_estimate() const noexcept {
  const Matrix3d& r = filter_.rotation;
  const Vector3d base = filter_.position - r * filter_.geometry().imu_in_base;
  const double yaw = yaw_of(r);
  FullEstimate full;
  full.pose = {base.x() + std::cos(yaw) * geometry_.axle_x - std::sin(yaw) * geometry_.axle_y,
               base.y() + std::sin(yaw) * geometry_.axle_x + std::cos(yaw) * geometry_.axle_y, yaw};
  const auto& p = filter_.covariance;
  const auto entry = [&](int i, int j) { return p(kPlanarAxes[i], kPlanarAxes[j]); };
  full.covariance = {
      .xx = entry(0, 0), .xy = entry(0, 1), .yy = entry(1, 1), .xw = entry(0, 2), .yw = entry(1, 2), .ww = entry(2, 2)};
  const Vector3d linear = filter_.velocity - filter_.rate.cross(filter_.geometry().imu_in_base);
  full.forward = linear.x() - filter_.rate.z() * geometry_.axle_y;
  full.sideways = linear.y() + filter_.rate.z() * geometry_.axle_x;
  full.up = array(r.row(2).transpose());
  full.holds = resting_;
  full.slips = slip_.reasons() != 0;
  return full;
}

PlanarPose Estimator::base_of(const PlanarPose& middle) const noexcept {
  const double c = std::cos(middle.yaw);
  const double s = std::sin(middle.yaw);
  return {middle.x - c * geometry_.axle_x + s * geometry_.axle_y,
          middle.y - s * geometry_.axle_x - c * geometry_.axle_y, middle.yaw};
}

void Estimator::place_simply() noexcept {
  const FullEstimate full = full_estimate();
  for (const auto horizon : {SimplePart::kShort, SimplePart::kLong}) {
    simple_.place(horizon, full.pose, full.covariance);
  }
}

void Estimator::place_at(const PlanarTrack& track) noexcept {
  const PlanarPose base = base_of(track.pose());
  place({base.x, base.y, base.yaw}, filter_);
  const auto known = track.covariance().pose();
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) filter_.covariance(kPlanarAxes[i], kPlanarAxes[j]) += known[i][j];
  }
}

void Estimator::renew() noexcept {
  const double height = filter_.position.z();
  filter_.reset();
  filter_.radius_ratio = parameters_.calibration.radius_ratio - 1;
  filter_.wheel_base = parameters_.calibration.wheel_base_factor - 1;
  filter_.gyro_bias = vector(simple_.rest().bias());
  for (int i = 0; i < 3; ++i) {
    filter_.covariance(Filter::kGyroBias + i, Filter::kGyroBias + i) = simple_.rest().variance();
  }
  const Tilt& tilt = simple_.tilt();
  filter_.rotation =
      (Eigen::AngleAxisd(tilt.pitch(), Vector3d::UnitY()) * Eigen::AngleAxisd(tilt.roll(), Vector3d::UnitX()))
          .toRotationMatrix();
  if (std::isfinite(height)) filter_.position.z() = height;
  filter_.rate = Vector3d(0, 0, simple_.rate());
  filter_.velocity = Vector3d(wheel_speed(), 0, 0) + filter_.rate.cross(filter_.geometry().imu_in_base);
  place_at(simple_.track(SimplePart::kLong));
  for (const int i : {kLeft, kRight}) {
    Side& side = sides_[static_cast<std::size_t>(i)];
    side.ahead = 0;
    side.refused = 0;
    filter_.anchor_travel(i, side.total);
  }
  standstill_.reset();
  resting_ = simple_.rest().resting();
  held_ = {};
  rested_ = 0;
  distrusted_windows_ = 0;
  slip_.begin(filter_);
}

void Estimator::accept() noexcept {
  place_at(simple_.track(SimplePart::kLong));
  slip_.renew(filter_);
}

void Estimator::fill_simply(StateFrame& out) const noexcept {
  const PlanarTrack& track = simple_.track(SimplePart::kLong);
  PlanarPose middle = track.pose();
  const double roll = simple_.tilt().roll();
  const double pitch = simple_.tilt().pitch();
  const bool rests = simple_.rest().resting();
  if (!rests) {
    for (const Side& side : sides_) {  // until the next readings
      const double ahead =
          side.encoder.received() ? 0 : side.speed.speed() * std::min(side.encoder.waiting(), side.encoder.gap());
      middle.x += std::cos(middle.yaw) * ahead / 2;
      middle.y += std::sin(middle.yaw) * ahead / 2;
    }
  }
  const PlanarPose base = base_of(middle);
  const Matrix3d rotation = (Eigen::AngleAxisd(base.yaw, Vector3d::UnitZ()) *
                             Eigen::AngleAxisd(pitch, Vector3d::UnitY()) * Eigen::AngleAxisd(roll, Vector3d::UnitX()))
                                .toRotationMatrix();
  out.attitude = quaternion_of(rotation);
  out.pose_odom.position = {base.x, base.y, parameters_.planar ? 0 : out.pose_odom.position[2]};
  out.pose_odom.orientation =
      parameters_.planar ? Quaternion{0, 0, std::sin(base.yaw / 2), std::cos(base.yaw / 2)} : out.attitude;
  const auto entries = track.covariance().pose();
  constexpr std::size_t kAt[3] = {0, 1, 5};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) out.pose_covariance[6 * kAt[i] + kAt[j]] = entries[i][j];
  }
  const double rate = rests ? 0 : rate_.rate().z();
  const Motion velocity = geometry_.base_motion(rests ? 0 : wheel_speed(), rate);
  out.twist_base = {{velocity.forward, velocity.left, 0}, {0, 0, rate}};
  if (!parameters_.planar && !rests) out.twist_base.angular = array(rate_.rate());
  const RestBias& known = simple_.rest();
  const double deviation = std::sqrt(known.variance());
  out.gyro_bias = array(base_from_imu_.transpose() * vector(known.bias()));
  out.gyro_bias_deviation = {deviation, deviation, deviation};
  out.calibration = parameters_.calibration;
  if (!parameters_.self_calibration) out.calibration.radius_ratio_deviation = out.calibration.wheel_base_deviation = 0;
  out.slip = simple_.slip().reasons();
  out.flags &= ~std::uint64_t{kStateSlip | kStateStandstill};
  out.flags |= kStateDegraded;
  if (out.slip != 0) out.flags |= kStateSlip;
  if (rests) out.flags |= kStateStandstill;
  out.degraded = supervision_.reasons();
}

}  // namespace robot_control
