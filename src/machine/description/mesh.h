#pragma once
/// Reads mesh files as clouds of points and computes the corners of their convex hulls for contact and measurements.
///
/// The formats STL, OBJ and DAE (COLLADA) are recognised by the file name's ending in either case.
///   STL   binary if the length is 84 + 50 n bytes with the count n in bytes 80…83, else text: binary files may also
///         begin with the word "solid". Lengths are in metres, as in rviz.
///   OBJ   lengths are in metres.
///   DAE   through assimp: the nodes' transforms and `<unit meter="…">` apply. `<up_axis>` is ignored, as in rviz and
///         Gazebo, in which authors of a URDF check the position of their meshes (rviz issue 1045, gazebo-classic issue
///         1305).
/// Points that no face uses, lines, and points at infinity are no part of a mesh.

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace robot_control {

using Points = std::vector<Eigen::Vector3d>;

/// Returns the corners of all faces, each once, in the order of x, y, z, in m and mesh axes; never empty. `not_finite`
/// counts the points that are infinite or not a number.
///
/// Throws RobotError with file and remedy if the file is missing, cannot be read or is larger than kMaxMeshSize. A file
/// of another format, one that is cut short or broken, and one without a face are refused, too.
Points read_mesh(const std::filesystem::path& path, std::size_t* not_finite = nullptr);

/// Returns the corners of the convex hull, in the order of x, y, z. A flat cloud gives the corners of its polygon, a
/// straight one its two ends, a single point itself. Directions in which the cloud is thinner than 10⁻⁶ of its largest
/// extent do not count.
///
/// At most kMaxHullCorners are kept: those that span the bounding box, then always the corner farthest from all that
/// are kept. The hull lies inside the true one by less than the distance of the last one added. For a ball of any
/// fineness that is at most 10 % of the radius, and the loss in depth is below 0.5 %.
Points hull_corners(const Points& points);

/// Returns the faces of the convex hull, for pictures: three indices into `points` each, counter-clockwise from
/// outside. It returns none for a flat cloud.
std::vector<std::array<std::size_t, 3>> hull_triangles(const Points& points);

struct MeshCorners {
  Points points;
  std::size_t not_finite = 0;  ///< infinite or undefined points that are left out
};

/// Returns hull_corners(read_mesh(path)), cached until the file's size or modification time changes. The hull may be
/// scaled afterwards, because its corners stay corners.
MeshCorners mesh_corners(const std::filesystem::path& path);

inline constexpr std::size_t kMaxHullCorners = 1000;
inline constexpr std::uintmax_t kMaxMeshSize = 100U << 20U;  ///< bytes

}  // namespace robot_control
