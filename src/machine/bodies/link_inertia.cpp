#include "machine/bodies/link_inertia.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "machine/description/urdf_document.h"
#include "machine/description/wording.h"

namespace robot_control {
namespace {

std::string moments(const Eigen::Matrix3d& inertia) {
  const Eigen::Vector3d p = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia).eigenvalues();
  const double rounding = 1e-12 * p.cwiseAbs().maxCoeff();
  const auto text = [&](double moment) { return number(std::abs(moment) <= rounding ? 0 : moment); };
  return text(p[0]) + ", " + text(p[1]) + ", " + text(p[2]);
}

}  // namespace

Eigen::Matrix3d eigen_inertia(const urdf::Inertial& given) {
  Eigen::Matrix3d tensor;
  tensor << given.ixx, given.ixy, given.ixz, given.ixy, given.iyy, given.iyz, given.ixz, given.iyz, given.izz;
  return tensor;
}

Eigen::Isometry3d eigen_pose(const urdf::Pose& pose) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  const auto& q = pose.rotation;
  result.linear() = Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized().toRotationMatrix();
  result.translation() = Eigen::Vector3d(pose.position.x, pose.position.y, pose.position.z);
  return result;
}

Eigen::Matrix3d possible_inertia(const Eigen::Matrix3d& given, double mass) {
  const double least = mass * kMinGyration * kMinGyration;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(given);
  Eigen::Vector3d principal = solver.eigenvalues();
  if (principal[2] <= 0) return 0.4 * mass * kBallRadius * kBallRadius * Eigen::Matrix3d::Identity();
  const double enough = (1 + kThickness) * principal[2];
  if (principal[0] >= least && principal[0] + principal[1] >= enough) return given;

  principal = principal.cwiseMax(least);
  const double lacking = std::max(0.0, enough - principal[0] - principal[1]);
  principal[0] += lacking / 2;
  principal[1] += lacking / 2;
  return solver.eigenvectors() * principal.asDiagonal() * solver.eigenvectors().transpose();
}

bool is_possible(const Eigen::Matrix3d& given, double mass) {
  const Eigen::Vector3d principal =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(given, Eigen::EigenvaluesOnly).eigenvalues();
  return principal[0] >= mass * kMinGyration * kMinGyration && principal[0] + principal[1] >= (1 - 1e-9) * principal[2];
}

PointInertia inertia_of(const urdf::Link& link, const Eigen::Isometry3d& in_body, const std::string& source,
                        std::vector<RobotNote>& notes) {
  PointInertia result;
  if (!link.inertial) return result;
  const urdf::Inertial& given = *link.inertial;
  if (!(given.mass >= 0)) {
    refuse(source, link_element(link.name), "<mass value=\"" + number(given.mass) + "\"/>: a mass must not be negative",
           "Set the mass in kg");
  }
  if (given.mass == 0) return result;
  const Eigen::Matrix3d tensor = eigen_inertia(given);
  const Eigen::Matrix3d possible = possible_inertia(tensor, given.mass);
  if (!is_possible(tensor, given.mass)) {
    notes.push_back({RobotNote::Kind::kRepaired, link_element(link.name),
                     "principal moments of inertia " + moments(tensor) + " kg·m² belong to no body of " +
                         number(given.mass) + " kg: " + moments(possible) + " taken"});
  }
  const Eigen::Isometry3d frame = in_body * eigen_pose(given.origin);
  result.mass = given.mass;
  result.centre = frame.translation();
  result.inertia = frame.linear() * possible * frame.linear().transpose();
  return result;
}

PointInertia sum(const PointInertia& a, const PointInertia& b) {
  PointInertia both;
  both.mass = a.mass + b.mass;
  if (both.mass <= 0) return both;
  const auto about = [](const PointInertia& part, const Eigen::Vector3d& centre) -> Eigen::Matrix3d {
    const Eigen::Vector3d d = part.centre - centre;
    return part.inertia + part.mass * (d.squaredNorm() * Eigen::Matrix3d::Identity() - d * d.transpose());
  };
  both.centre = (a.mass * a.centre + b.mass * b.centre) / both.mass;
  both.inertia = about(a, both.centre) + about(b, both.centre);
  return both;
}

}  // namespace robot_control
