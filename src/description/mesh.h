#pragma once
/// Mesh files as clouds of points, and the corners of their convex hulls: what contact and measuring need of a mesh.
///
/// Read are STL, OBJ and DAE (COLLADA), recognised by the file name's ending in either case.
///   STL   binary when the length is 84 + 50 n bytes, n the count in bytes 80…83, else text: the word "solid" begins
///         genuine binary files, too. Lengths count as metres, as in rviz.
///   OBJ   likewise metres.
///   DAE   through assimp: the nodes' transforms and `<unit meter="…">` apply. `<up_axis>` does not, as in rviz and
///         Gazebo, in which authors of a URDF check the position of their meshes (rviz issue 1045, gazebo-classic issue
///         1305): coordinates are taken as they stand.
/// Points that no face uses, lines, and points at infinity are no part of a mesh.

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace robot_control {

using Points = std::vector<Eigen::Vector3d>;

/// The corners of all faces, each once, in the order of x, y, z; m in mesh axes. Never empty.
///
/// Throws RobotError with file and remedy: a file that is missing or cannot be read, that is no STL, OBJ or DAE, is
/// cut short or broken, has no face, or is larger than kLargestMesh.
///
/// `not_finite` counts the points that are infinite or not a number.
Points read_mesh(const std::filesystem::path& path, std::size_t* not_finite = nullptr);

/// The corners of the convex hull, in the order of x, y, z. A flat cloud gives the corners of its polygon, a straight
/// one its two ends, a single point itself: directions in which it is thinner than 10⁻⁶ of its largest extent do not
/// count.
///
/// Of more than kMostHullCorners, that many are kept: those that span the bounding box, then always the corner
/// farthest from all that are kept. The hull then lies inside the true one by less than the distance of the last one
/// added: at most 10 % of the radius for a ball of any fineness, where the loss in depth is below 0.5 %.
Points hull_corners(const Points& points);

/// The faces of the convex hull, for pictures: three indices into `points` each, counter-clockwise from outside. None
/// for a flat cloud.
std::vector<std::array<std::size_t, 3>> hull_triangles(const Points& points);

struct MeshCorners {
  Points points;
  std::size_t not_finite = 0;  ///< points at infinity, or none at all, that are left out
};

/// hull_corners(read_mesh(path)), remembered until the file's size or time of change is another. A hull may be scaled
/// afterwards: its corners stay corners.
MeshCorners mesh_corners(const std::filesystem::path& path);

inline constexpr std::size_t kMostHullCorners = 1000;
inline constexpr std::uintmax_t kLargestMesh = 100U << 20U;  ///< bytes

}  // namespace robot_control
