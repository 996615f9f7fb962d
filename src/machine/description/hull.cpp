#include <libqhull_r/qhull_ra.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cstdio>
#include <limits>
#include <string>
#include <tuple>

#include "machine/description/mesh.h"

namespace robot_control {
namespace {

constexpr double kThin = 1e-6;  // share of the largest extent: STL's single precision resolves 10⁻⁷

using Indices = std::vector<std::size_t>;

/// Holds the points in their principal axes about their mean, in units of the largest extent, and the number of
/// significant axes.
struct Cloud {
  Eigen::Matrix3Xd points;
  int dimension = 0;
  bool is_mirrored = false;  ///< The axes are a left-handed frame.
};

Cloud principal(const Points& points) {
  Cloud cloud;
  cloud.points.resize(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) cloud.points.col(static_cast<Eigen::Index>(i)) = points[i];
  const Eigen::Vector3d low = cloud.points.rowwise().minCoeff();
  const double largest = (cloud.points.rowwise().maxCoeff() - low).maxCoeff();
  if (!(largest > 0)) return cloud;
  cloud.points = (cloud.points.colwise() - low) / largest;
  cloud.points.colwise() -= cloud.points.rowwise().mean().eval();
  const Eigen::Matrix3d spread = cloud.points * cloud.points.transpose();
  const Eigen::Matrix3d axes =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().rowwise().reverse();
  cloud.is_mirrored = axes.determinant() < 0;
  cloud.points = axes.transpose() * cloud.points;
  const Eigen::Vector3d extent = cloud.points.rowwise().maxCoeff() - cloud.points.rowwise().minCoeff();
  while (cloud.dimension < 3 && extent[cloud.dimension] > kThin) ++cloud.dimension;
  return cloud;
}

Indices ends(const Cloud& cloud) {
  Eigen::Index low = 0;
  Eigen::Index high = 0;
  cloud.points.row(0).minCoeff(&low);
  cloud.points.row(0).maxCoeff(&high);
  return {static_cast<std::size_t>(low), static_cast<std::size_t>(high)};
}

/// Owns a Qhull instance. Its error file is not read.
class Qhull {
 public:
  Qhull() : silence_(std::fopen("/dev/null", "w")) { qh_zero(&qh_, silence_); }
  ~Qhull() {
    qh_freeqhull(&qh_, !qh_ALL);
    int current = 0;
    int total = 0;
    qh_memfreeshort(&qh_, &current, &total);
    if (silence_ != nullptr) std::fclose(silence_);
  }
  Qhull(const Qhull&) = delete;
  Qhull& operator=(const Qhull&) = delete;

  /// Returns false if Qhull fails.
  bool run(const Cloud& cloud, const char* options) {
    if (silence_ == nullptr) return false;
    coordinates_ = cloud.points.topRows(cloud.dimension);
    std::string command = options;
    count_ = static_cast<int>(coordinates_.cols());
    return qh_new_qhull(&qh_, cloud.dimension, count_, coordinates_.data(), 0, command.data(), nullptr, silence_) == 0;
  }

  Indices corners() {
    Indices result;
    for (vertexT* vertex = qh_.vertex_list; vertex != nullptr && vertex->next != nullptr; vertex = vertex->next) {
      const int id = qh_pointid(&qh_, vertex->point);
      if (id >= 0 && id < count_) result.push_back(static_cast<std::size_t>(id));
    }
    return result;
  }

  /// Returns the facets with three corners of a hull in three dimensions.
  std::vector<std::array<std::size_t, 3>> triangles() {
    std::vector<std::array<std::size_t, 3>> result;
    for (facetT* facet = qh_.facet_list; facet != nullptr && facet->next != nullptr; facet = facet->next) {
      if (qh_setsize(&qh_, facet->vertices) != 3) continue;
      std::array<std::size_t, 3> triangle{};
      for (std::size_t i = 0; i < 3; ++i) {
        const auto* vertex = static_cast<const vertexT*>(facet->vertices->e[i].p);
        triangle[i] = static_cast<std::size_t>(qh_pointid(&qh_, vertex->point));
      }
      if (is_clockwise(triangle, facet->normal)) std::swap(triangle[1], triangle[2]);
      result.push_back(triangle);
    }
    return result;
  }

 private:
  bool is_clockwise(const std::array<std::size_t, 3>& triangle, const double* outward) const {
    const auto corner = [&](std::size_t i) -> Eigen::Vector3d {
      return coordinates_.col(static_cast<Eigen::Index>(triangle[i]));
    };
    const Eigen::Vector3d normal = (corner(1) - corner(0)).cross(corner(2) - corner(0));
    return normal.dot(Eigen::Map<const Eigen::Vector3d>(outward)) < 0;
  }

  std::FILE* silence_;
  qhT qh_{};
  Eigen::MatrixXd coordinates_;  // Qhull points into it.
  int count_ = 0;
};

Indices corners_of(const Cloud& cloud) {
  if (cloud.dimension == 0) return {0};
  if (cloud.dimension == 1) return ends(cloud);
  for (const char* options : {"qhull Qt", "qhull QJ"}) {
    Qhull hull;
    if (hull.run(cloud, options)) return hull.corners();
  }
  Indices all;
  for (Eigen::Index i = 0; i < cloud.points.cols(); ++i) all.push_back(static_cast<std::size_t>(i));
  return all;
}

void order(Points& points) {
  const auto before = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return std::tie(a.x(), a.y(), a.z()) < std::tie(b.x(), b.y(), b.z());
  };
  std::sort(points.begin(), points.end(), before);
  points.erase(std::unique(points.begin(), points.end()), points.end());
}

Points thinned(const Points& corners) {
  std::vector<double> distance(corners.size(), std::numeric_limits<double>::infinity());
  Points kept;
  const auto keep = [&](std::size_t chosen) {
    kept.push_back(corners[chosen]);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      distance[i] = std::min(distance[i], (corners[i] - corners[chosen]).squaredNorm());
    }
  };
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const auto [low, high] =
        std::minmax_element(corners.begin(), corners.end(),
                            [axis](const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return a[axis] < b[axis]; });
    keep(static_cast<std::size_t>(low - corners.begin()));
    keep(static_cast<std::size_t>(high - corners.begin()));
  }
  while (kept.size() < kMaxHullCorners) {
    keep(static_cast<std::size_t>(std::max_element(distance.begin(), distance.end()) - distance.begin()));
  }
  return kept;
}

}  // namespace

Points hull_corners(const Points& points) {
  if (points.empty()) return {};
  Points corners;
  for (const std::size_t index : corners_of(principal(points))) corners.push_back(points[index]);
  order(corners);
  if (corners.size() > kMaxHullCorners) {
    corners = thinned(corners);
    order(corners);
  }
  return corners;
}

std::vector<std::array<std::size_t, 3>> hull_triangles(const Points& points) {
  if (points.empty()) return {};
  const Cloud cloud = principal(points);
  if (cloud.dimension < 3) return {};
  Qhull hull;
  if (!hull.run(cloud, "qhull Qt")) return {};
  auto triangles = hull.triangles();
  for (auto& triangle : triangles) {
    if (cloud.is_mirrored) std::swap(triangle[1], triangle[2]);
  }
  return triangles;
}

}  // namespace robot_control
