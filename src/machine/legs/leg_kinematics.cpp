#include "machine/legs/leg_kinematics.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace robot_control {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kReachTolerance = 1e-12;  // relative, of lengths at the border of reach
constexpr double kRangeTolerance = 1e-9;   // rad by which rounding may exceed a range
constexpr double kNoBend = 1e-6;           // rad, of a knee that is not to pass the straight leg

/// Returns the vector (x, z) turned by `angle` about y.
struct Plane {
  double x = 0, z = 0;
};
Plane turned(double x, double z, double sine, double cosine) noexcept {
  return {x * cosine + z * sine, z * cosine - x * sine};
}

/// Moves an angle by whole turns into its range, or as near to it as they allow.
double into(double angle, const JointRange& range) noexcept {
  const double middle = std::isinf(range.lower) ? 0 : (range.lower + range.upper) / 2;
  return middle + wrapped(angle - middle);
}

bool within(double angle, const JointRange& range) noexcept {
  return angle >= range.lower - kRangeTolerance && angle <= range.upper + kRangeTolerance;
}

}  // namespace

double wrapped(double angle) noexcept {
  if (angle > -kPi && angle <= kPi) return angle;
  return std::remainder(angle, 2 * kPi);
}

LegKinematics::LegKinematics(const LegGeometry& geometry)
    : geometry_(geometry),
      range_(geometry.range),
      offset_(geometry.upper.y() + geometry.lower.y() + geometry.foot.y()),
      upper_length_(std::hypot(geometry.lower.x(), geometry.lower.z())),
      lower_length_(std::hypot(geometry.foot.x(), geometry.foot.z())),
      upper_angle_(std::atan2(geometry.lower.x(), geometry.lower.z())),
      lower_angle_(std::atan2(geometry.foot.x(), geometry.foot.z())) {
  // θ₃ = straight + β with β of the sign `bend`.
  const double straight = geometry.sign[2] * (upper_angle_ - lower_angle_);
  const double away = geometry.sign[2] * geometry.bend;
  JointRange side{std::min(away * kNoBend, away * kPi), std::max(away * kNoBend, away * kPi)};
  const double middle = straight + (side.lower + side.upper) / 2;
  const double turns = std::isinf(range_[2].lower)
                           ? wrapped(middle) - middle
                           : 2 * kPi * std::round(((range_[2].lower + range_[2].upper) / 2 - middle) / (2 * kPi));
  range_[2] = {std::max(range_[2].lower, straight + side.lower + turns),
               std::min(range_[2].upper, straight + side.upper + turns)};
}

double LegKinematics::bend(const LegAngles& angles) const noexcept {
  return wrapped(geometry_.sign[2] * angles[2] + lower_angle_ - upper_angle_);
}

double LegKinematics::stretch(const LegAngles& angles) const noexcept {
  const double a = upper_length_, b = lower_length_;
  return std::sqrt(std::max(0.0, a * a + b * b + 2 * a * b * std::cos(bend(angles))));
}

double LegKinematics::knee_lever(double stretch) const noexcept {
  const double a = upper_length_, b = lower_length_;
  const double cosine = (stretch * stretch - a * a - b * b) / (2 * a * b);
  return a * b * std::sqrt(std::max(0.0, 1 - cosine * cosine)) / stretch;
}

Eigen::Vector3d LegKinematics::position(const LegAngles& angles) const noexcept {
  const double first = geometry_.sign[0] * angles[0];
  const double second = geometry_.sign[1] * angles[1];
  const double third = second + geometry_.sign[2] * angles[2];
  const double s = std::sin(first), c = std::cos(first);
  const Plane lower = turned(geometry_.lower.x(), geometry_.lower.z(), std::sin(second), std::cos(second));
  const Plane foot = turned(geometry_.foot.x(), geometry_.foot.z(), std::sin(third), std::cos(third));
  const double x = geometry_.upper.x() + lower.x + foot.x, z = geometry_.upper.z() + lower.z + foot.z;
  return geometry_.hip + Eigen::Vector3d(x, c * offset_ - s * z, s * offset_ + c * z);
}

Eigen::Vector3d LegKinematics::knee(const LegAngles& angles) const noexcept {
  const double first = geometry_.sign[0] * angles[0], second = geometry_.sign[1] * angles[1];
  const double s = std::sin(first), c = std::cos(first);
  const Plane lower = turned(geometry_.lower.x(), geometry_.lower.z(), std::sin(second), std::cos(second));
  const double y = geometry_.upper.y() + geometry_.lower.y(), z = geometry_.upper.z() + lower.z;
  return geometry_.hip + Eigen::Vector3d(geometry_.upper.x() + lower.x, c * y - s * z, s * y + c * z);
}

Eigen::Matrix3d LegKinematics::jacobian(const LegAngles& angles, Eigen::Vector3d& foot) const noexcept {
  const double first = geometry_.sign[0] * angles[0];
  const double second = geometry_.sign[1] * angles[1];
  const double third = second + geometry_.sign[2] * angles[2];
  const double s = std::sin(first), c = std::cos(first);
  const Plane lower = turned(geometry_.lower.x(), geometry_.lower.z(), std::sin(second), std::cos(second));
  const Plane shank = turned(geometry_.foot.x(), geometry_.foot.z(), std::sin(third), std::cos(third));
  const Plane from_second{lower.x + shank.x, lower.z + shank.z};
  const double x = geometry_.upper.x() + from_second.x, z = geometry_.upper.z() + from_second.z;
  const Eigen::Vector3d from_hip(x, c * offset_ - s * z, s * offset_ + c * z);
  foot = geometry_.hip + from_hip;
  Eigen::Matrix3d result;
  result.col(0) = geometry_.sign[0] * Eigen::Vector3d(0, -from_hip.z(), from_hip.y());
  result.col(1) = geometry_.sign[1] * Eigen::Vector3d(from_second.z, s * from_second.x, -c * from_second.x);
  result.col(2) = geometry_.sign[2] * Eigen::Vector3d(shank.z, s * shank.x, -c * shank.x);
  return result;
}

/// `side` is −1 for a leg below its hip and +1 for one above it. Beyond reach, the angles are those of a leg that is
/// stretched or folded towards the foot.
LegKinematics::Branch LegKinematics::branch(const Eigen::Vector3d& from_hip, double side) const noexcept {
  Branch result{.reached = true};
  const double across = from_hip.y() * from_hip.y() + from_hip.z() * from_hip.z();
  double height = across - offset_ * offset_;
  if (height < 0) {
    result.reached = height >= -kReachTolerance * across;
    height = 0;
  }
  const double z = side * std::sqrt(height);
  const double along_x = from_hip.x() - geometry_.upper.x(), along_z = z - geometry_.upper.z();
  const double a = upper_length_, b = lower_length_;
  double cosine = (along_x * along_x + along_z * along_z - a * a - b * b) / (2 * a * b);
  if (std::abs(cosine) > 1) {
    result.reached = result.reached && std::abs(cosine) <= 1 + kReachTolerance;
    cosine = std::clamp(cosine, -1.0, 1.0);
  }
  const double bend = geometry_.bend * std::acos(cosine);
  const double sine = geometry_.bend * std::sqrt(1 - cosine * cosine);
  const double towards = std::atan2(along_x, along_z) - std::atan2(b * sine, a + b * cosine);
  const LegAngles turned_by(std::atan2(from_hip.z(), from_hip.y()) - std::atan2(z, offset_), towards - upper_angle_,
                            bend + upper_angle_ - lower_angle_);
  result.in_range = true;
  for (std::size_t i = 0; i < kLegJoints; ++i) {
    const double angle = into(geometry_.sign[i] * turned_by[i], range_[i]);
    result.in_range = result.in_range && within(angle, range_[i]);
    result.angles[i] = std::clamp(angle, range_[i].lower, range_[i].upper);
  }
  return result;
}

std::optional<LegAngles> LegKinematics::reached(const Eigen::Vector3d& foot) const noexcept {
  for (const double side : {-1.0, 1.0}) {
    const Branch found = branch(foot - geometry_.hip, side);
    if (found.reached && found.in_range) return found.angles;
  }
  return std::nullopt;
}

LegSolution LegKinematics::inverse(const Eigen::Vector3d& foot) const noexcept {
  if (const std::optional<LegAngles> angles = reached(foot)) return {*angles, FootReach::kReached};
  const Eigen::Vector3d from_hip = foot - geometry_.hip;
  const Branch below = branch(from_hip, -1), above = branch(from_hip, 1);
  LegSolution result{.angles = below.angles};  // stays where the distance is not finite
  result.reach = below.reached || above.reached ? FootReach::kBeyondRange : FootReach::kBeyondReach;
  double best = std::numeric_limits<double>::infinity();
  const auto try_from = [&](const LegAngles& start) {
    double distance = 0;
    const LegAngles found = nearest(foot, start, distance);
    if (distance < best) result.angles = found;
    best = std::min(best, distance);
  };
  // The thigh's range may end on the way, so that the search also begins at both of its ends.
  for (LegAngles start : {below.angles, above.angles}) {
    try_from(start);
    if (std::isinf(range_[1].lower)) continue;
    for (const double end : {range_[1].lower, range_[1].upper}) {
      start[1] = end;
      try_from(start);
    }
  }
  for (std::size_t i = 0; i < kLegJoints; ++i)
    if (range_[i].upper - range_[i].lower >= 2 * kPi) result.angles[i] = into(result.angles[i], range_[i]);
  return result;
}

}  // namespace robot_control
