#include "estimation/simple/planar_track.h"

#include <numbers>

namespace robot_control {

void PlanarTrack::turn(double angle, double dt, bool by_gyro) noexcept {
  pose_.yaw = std::remainder(pose_.yaw + angle, 2 * std::numbers::pi);
  PlanarCovariance& p = covariance_;
  const double turned = std::abs(angle);
  if (!by_gyro) {
    p.ww += noise_.turn * noise_.turn * turned;
    return;
  }
  p.ww += (p.bb * dt - 2 * p.wb) * dt + noise_.gyro * noise_.gyro * dt + noise_.scale * noise_.scale * turned;
  p.xw -= p.xb * dt;
  p.yw -= p.yb * dt;
  p.wb -= p.bb * dt;
}

void PlanarTrack::roll(double distance, double before) noexcept {
  const double heading = pose_.yaw - before;
  const double dx = distance * std::cos(heading);
  const double dy = distance * std::sin(heading);
  pose_.x += dx;
  pose_.y += dy;
  path_ += std::abs(distance);
  PlanarCovariance& p = covariance_;
  p.xx += (dy * p.ww - 2 * p.xw) * dy;
  p.yy += (dx * p.ww + 2 * p.yw) * dx;
  p.xy += dx * p.xw - dy * p.yw - dx * dy * p.ww;
  p.xw -= dy * p.ww;
  p.yw += dx * p.ww;
  p.xb -= dy * p.wb;
  p.yb += dx * p.wb;
  const double slip = noise_.slip * noise_.slip * std::abs(distance);
  p.xx += slip;
  p.yy += slip;
}

}  // namespace robot_control
