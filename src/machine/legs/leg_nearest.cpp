/// The nearest point that a leg can reach minimises f(q) = ½ |p(q) − foot|² within the joints' ranges. Newton's method
/// with the exact Hessian, projected on the ranges, goes down from the start. With r = p − foot, the axes aᵢ and the
/// columns Jᵢ of the Jacobian,
///
///   gᵢ = Jᵢ·r      Hᵢⱼ = Jᵢ·Jⱼ + r·(aᵢ × Jⱼ),  i ≤ j from the body outwards

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "machine/legs/leg_kinematics.h"

namespace robot_control {
namespace {

constexpr int kSteps = 30;
constexpr int kTrials = 12;  // with growing damping
constexpr double kMinDamping = 1e-3;
constexpr double kConverged = 1e-10;  // rad

LegAngles clamped(const LegAngles& angles, const std::array<JointRange, kLegJoints>& range) noexcept {
  LegAngles result;
  for (std::size_t i = 0; i < kLegJoints; ++i) result[i] = std::clamp(angles[i], range[i].lower, range[i].upper);
  return result;
}

/// −g and H, where the joints at the ends of their ranges that would leave them are held.
struct Slope {
  Eigen::Vector3d downhill;
  Eigen::Matrix3d hessian;
};

Slope slope(const LegGeometry& geometry, const std::array<JointRange, kLegJoints>& range, const LegAngles& angles,
            const Eigen::Matrix3d& jacobian, const Eigen::Vector3d& rest) noexcept {
  const double turn = geometry.sign[0] * angles[0];
  const Eigen::Vector3d lateral(0, std::cos(turn), std::sin(turn));
  const std::array<Eigen::Vector3d, kLegJoints> axes{geometry.sign[0] * Eigen::Vector3d::UnitX(),
                                                     geometry.sign[1] * lateral, geometry.sign[2] * lateral};
  Slope result{.downhill = -jacobian.transpose() * rest, .hessian = jacobian.transpose() * jacobian};
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = i; j < 3; ++j) {
      const double curve = rest.dot(axes[static_cast<std::size_t>(i)].cross(jacobian.col(j)));
      result.hessian(i, j) += curve;
      if (j > i) result.hessian(j, i) += curve;
    }
  }
  for (std::size_t i = 0; i < kLegJoints; ++i) {
    const double step_down = result.downhill[i];
    const bool held = (angles[i] <= range[i].lower && step_down < 0) || (angles[i] >= range[i].upper && step_down > 0);
    if (!held) continue;
    result.downhill[i] = 0;
    result.hessian.row(i).setZero();
    result.hessian.col(i).setZero();
    result.hessian(i, i) = 1;
  }
  return result;
}

}  // namespace

LegAngles LegKinematics::nearest(const Eigen::Vector3d& foot, const LegAngles& start, double& distance) const noexcept {
  LegAngles angles = clamped(start, range_);
  Eigen::Vector3d place;
  Eigen::Matrix3d jacobian = this->jacobian(angles, place);
  double damping = 0;
  for (int step = 0; step < kSteps; ++step) {
    const Slope here = slope(geometry_, range_, angles, jacobian, place - foot);
    const double scale = here.hessian.diagonal().cwiseAbs().maxCoeff();
    double moved = 0;
    for (int trial = 0; trial < kTrials && moved == 0; ++trial) {
      const Eigen::Matrix3d damped = here.hessian + damping * scale * Eigen::Matrix3d::Identity();
      const Eigen::Vector3d move = (damped.inverse() * here.downhill).cwiseMax(-1).cwiseMin(1);
      const LegAngles next = clamped(angles + move, range_);
      Eigen::Vector3d next_place;
      const Eigen::Matrix3d next_jacobian = this->jacobian(next, next_place);
      if ((next_place - foot).squaredNorm() < (place - foot).squaredNorm()) {
        moved = (next - angles).cwiseAbs().maxCoeff();
        angles = next;
        place = next_place;
        jacobian = next_jacobian;
        damping = damping > kMinDamping ? damping / 10 : 0;
      } else {
        damping = std::max(4 * damping, kMinDamping);
      }
    }
    if (moved < kConverged) break;
  }
  distance = (place - foot).norm();
  return angles;
}

}  // namespace robot_control
