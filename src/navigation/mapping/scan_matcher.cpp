#include "navigation/mapping/scan_matcher.h"

#include <Eigen/Cholesky>

namespace robot_control::navigation {
namespace {

constexpr int kIterations = 30;
constexpr double kSettled = 1e-4;                 // m, rad
constexpr double kPointDeviation = 0.05;          // m, of a point; neighbours err alike, so it is more than the laser's
constexpr double kOutlier = 0.1;                  // m, of Cauchy's weight
constexpr double kSameSide = 0.5;                 // cosine between two normals of the same wall
const Eigen::Vector3d kLeast(0.01, 0.01, 0.003);  // deviation of a match: walls have errors of their own

struct Pair {
  Eigen::Vector2d point, offset, normal;  // the point turned into the axes of the walls; from the wall to it
  double weight;
};

std::vector<Pair> pairs_of(const PointField& walls, const std::vector<WallPoint>& seen, const PlanarPose& pose,
                           Match& result) {
  const Eigen::Rotation2Dd turn(pose.yaw);
  const Eigen::Vector2d at(pose.x, pose.y);
  std::vector<Pair> pairs;
  result.matched = 0;
  result.explained.assign(seen.size(), false);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const Eigen::Vector2d point = turn * seen[i].at;
    const WallPoint* wall = walls.nearest(point + at);
    if (wall == nullptr) continue;
    const Eigen::Vector2d faced = turn * seen[i].normal;
    if (!wall->normal.isZero() && !faced.isZero() && wall->normal.dot(faced) < kSameSide) continue;
    const Eigen::Vector2d offset = point + at - wall->at, normal = wall->normal.isZero() ? faced : wall->normal;
    const double off = normal.isZero() ? offset.norm() : normal.dot(offset);
    const double weight = 1 / (1 + off * off / (kOutlier * kOutlier));
    pairs.push_back({point, offset, normal, weight / (kPointDeviation * kPointDeviation)});
    if (std::abs(off) > kOutlier) continue;
    ++result.matched;
    result.explained[i] = true;
  }
  return pairs;
}

/// Returns the projection on the observed directions.
Eigen::Matrix2d observed(const std::vector<Pair>& pairs) {
  Eigen::Matrix2d normals = Eigen::Matrix2d::Zero();
  double sum = 0;
  for (const Pair& pair : pairs) {
    sum += pair.weight;
    if (pair.normal.isZero()) {
      normals += pair.weight / 2 * Eigen::Matrix2d::Identity();
    } else {
      normals += pair.weight * pair.normal * pair.normal.transpose();
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> parts(normals);
  Eigen::Matrix2d result = Eigen::Matrix2d::Zero();
  for (int i = 0; i < 2; ++i) {
    if (parts.eigenvalues()[i] > kObserved * sum) {
      result += parts.eigenvectors().col(i) * parts.eigenvectors().col(i).transpose();
    }
  }
  return result;
}

}  // namespace

Match match(const PointField& walls, const std::vector<WallPoint>& seen, const PlanarPose& start,
            const UncertainPose& predicted) {
  const Eigen::Matrix3d known = at_least(predicted.covariance, Eigen::Vector3d::Constant(1e-4)).inverse();
  Match result;
  result.pose.mean = start;
  PlanarPose& pose = result.pose.mean;
  Eigen::Matrix3d information;
  for (int i = 0; i < kIterations; ++i) {
    const std::vector<Pair> pairs = pairs_of(walls, seen, pose, result);
    const Eigen::Matrix2d directions = observed(pairs);
    const PlanarPose& mean = predicted.mean;
    Eigen::Vector3d gradient =
        known * Eigen::Vector3d(pose.x - mean.x, pose.y - mean.y, std::remainder(pose.yaw - mean.yaw, 2 * M_PI));
    information = known;
    const auto add = [&](const Pair& pair, const Eigen::Vector2d& direction) {
      const Eigen::Vector3d row(direction.x(), direction.y(),
                                direction.y() * pair.point.x() - direction.x() * pair.point.y());
      information += pair.weight * row * row.transpose();
      gradient += pair.weight * direction.dot(pair.offset) * row;
    };
    for (const Pair& pair : pairs) {
      if (pair.normal.isZero()) {
        add(pair, directions.col(0)), add(pair, directions.col(1));
      } else {
        add(pair, directions * pair.normal);
      }
    }
    const Eigen::Vector3d step = information.ldlt().solve(-gradient);
    pose = {pose.x + step.x(), pose.y + step.y(), pose.yaw + step.z()};
    if (step.cwiseAbs().maxCoeff() < kSettled) break;
  }
  result.pose.covariance = at_least(information.inverse(), kLeast);
  return result;
}

}  // namespace robot_control::navigation
