#pragma once
/// A pose with its covariance, and how such poses are composed to first order.

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <cmath>

#include "navigation/grid.h"

namespace robot_control::navigation {

/// A pose with its covariance: x m, y m, yaw rad.
struct UncertainPose {
  PlanarPose mean;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// Returns the rotation by this angle of the first two of three variables.
inline Eigen::Matrix3d planar_rotation(double angle) {
  Eigen::Matrix3d result = Eigen::Matrix3d::Identity();
  result.topLeftCorner<2, 2>() << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  return result;
}

/// Returns the derivative of a composed pose by the first one, to which it adds `x` and `y` m in the fixed axes.
inline Eigen::Matrix3d derivative_by_first(double x, double y) {
  Eigen::Matrix3d result = Eigen::Matrix3d::Identity();
  result(0, 2) = -y;
  result(1, 2) = x;
  return result;
}

inline UncertainPose inverse(const UncertainPose& pose) {
  const PlanarPose mean = inverse(pose.mean);
  const Eigen::Matrix3d f = planar_rotation(mean.yaw) * derivative_by_first(-pose.mean.x, -pose.mean.y);
  return {mean, f * pose.covariance * f.transpose()};
}

/// Returns `inner`, given in the frame of `outer`, in the frame in which `outer` is given. Their errors are
/// independent.
inline UncertainPose composed(const UncertainPose& outer, const UncertainPose& inner) {
  const PlanarPose mean = composed(outer.mean, inner.mean);
  const Eigen::Matrix3d f = derivative_by_first(mean.x - outer.mean.x, mean.y - outer.mean.y);
  const Eigen::Matrix3d r = planar_rotation(outer.mean.yaw);
  return {mean, f * outer.covariance * f.transpose() + r * inner.covariance * r.transpose()};
}

/// Returns the positive part of a symmetric matrix, with each variance enlarged by that of `least`.
inline Eigen::Matrix3d at_least(const Eigen::Matrix3d& matrix, const Eigen::Vector3d& least) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> parts((matrix + matrix.transpose()) / 2);
  Eigen::Matrix3d result =
      parts.eigenvectors() * parts.eigenvalues().cwiseMax(0).asDiagonal() * parts.eigenvectors().transpose();
  result.diagonal() += least.cwiseProduct(least);
  return result;
}

/// Returns the covariance of the step between two poses of the odometry, in the axes of the first one.
///
///   Σ₂ − F Σ₁ Fᵀ = Σᵢ λᵢ vᵢ vᵢᵀ    F: derivative of the second pose by the first one
///
/// In a direction vᵢ in which the covariance grows, λᵢ is that of the errors of the motion. If it shrinks, the odometry
/// has corrected its past path, and the expected square of that correction is −λᵢ. The correction that is shown is at
/// most the part vᵢᵀ s of the step s.
inline Eigen::Matrix3d growth(const UncertainPose& from, const UncertainPose& to) {
  const Eigen::Matrix3d f = derivative_by_first(to.mean.x - from.mean.x, to.mean.y - from.mean.y);
  const Eigen::Matrix3d r = planar_rotation(-from.mean.yaw);
  const Eigen::Matrix3d grown = r * (to.covariance - f * from.covariance * f.transpose()) * r.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> parts((grown + grown.transpose()) / 2);
  const PlanarPose step = composed(inverse(from.mean), to.mean);
  const Eigen::Vector3d shown =
      parts.eigenvectors().transpose() * Eigen::Vector3d(step.x, step.y, std::remainder(step.yaw, 2 * M_PI));
  const Eigen::Vector3d size = parts.eigenvalues().cwiseMax((-parts.eigenvalues()).cwiseMin(shown.cwiseAbs2()));
  return parts.eigenvectors() * size.asDiagonal() * parts.eigenvectors().transpose();
}

}  // namespace robot_control::navigation
