#include "robot/link_shapes.h"

#include <cmath>

#include "description/mesh.h"
#include "description/resource.h"
#include "description/urdf_document.h"
#include "description/wording.h"
#include "robot/link_inertia.h"

namespace robot_control {
namespace {

std::vector<Eigen::Vector3d> mesh_points(const urdf::Mesh& mesh, const std::string& element,
                                         const RobotDescription& description) {
  const Eigen::Vector3d scale(mesh.scale.x, mesh.scale.y, mesh.scale.z);
  if (!scale.allFinite() || (scale.array() == 0).any()) {
    refuse(description.source, element, "<mesh filename=\"" + mesh.filename + "\">: its scale is empty or zero",
           "Give scale=\"1 1 1\" for a mesh in metres, \"0.001 0.001 0.001\" for one in millimetres");
  }
  try {
    std::vector<Eigen::Vector3d> points = mesh_corners(resolve_resource(mesh.filename, description));
    for (Eigen::Vector3d& point : points) point = point.cwiseProduct(scale);
    return points;
  } catch (const RobotError& error) {
    // What names the URDF itself names it once.
    const std::string prefix = description.source + ": ";
    const std::string text = error.what();
    throw RobotError(prefix + element + ": " + (text.starts_with(prefix) ? text.substr(prefix.size()) : text));
  }
}

Shape read_shape(const urdf::Geometry& geometry, const std::string& element, const RobotDescription& description) {
  Shape shape;
  switch (geometry.type) {
    case urdf::Geometry::SPHERE:
      shape.type = ShapeType::kSphere;
      shape.radius = static_cast<const urdf::Sphere&>(geometry).radius;
      break;
    case urdf::Geometry::CYLINDER:
      shape.type = ShapeType::kCylinder;
      shape.radius = static_cast<const urdf::Cylinder&>(geometry).radius;
      shape.length = static_cast<const urdf::Cylinder&>(geometry).length;
      break;
    case urdf::Geometry::BOX: {
      const auto& dim = static_cast<const urdf::Box&>(geometry).dim;
      shape.type = ShapeType::kBox;
      shape.size = Eigen::Vector3d(dim.x, dim.y, dim.z);
      break;
    }
    case urdf::Geometry::MESH:
      shape.type = ShapeType::kMesh;
      shape.points = mesh_points(static_cast<const urdf::Mesh&>(geometry), element, description);
      break;
  }
  return shape;
}

std::vector<double> sizes_of(const Shape& shape) {
  switch (shape.type) {
    case ShapeType::kSphere:
      return {shape.radius};
    case ShapeType::kCylinder:
      return {shape.radius, shape.length};
    case ShapeType::kBox:
      return {shape.size.x(), shape.size.y(), shape.size.z()};
    case ShapeType::kMesh:
      break;
  }
  return {1};
}

bool has_extent(const Shape& shape, const std::string& source, const std::string& element) {
  bool extent = true;
  for (const double size : sizes_of(shape)) {
    if (!std::isfinite(size) || size < 0) {
      refuse(source, element, "a shape with a size of " + number(size) + " m", "Give sizes above zero");
    }
    extent = extent && size > 0;
  }
  return extent;
}

}  // namespace

std::vector<Shape> shapes_of(const urdf::Link& link, ShapeSource which, const Eigen::Isometry3d& in_body,
                             const RobotDescription& description, std::vector<RobotNote>& notes) {
  std::vector<Shape> shapes;
  const std::string element = link_element(link.name);
  const auto add = [&](const auto& given, const std::string& kind) {
    if (!given || !given->geometry) return;
    Shape shape = read_shape(*given->geometry, element + kind, description);
    shape.in_body = in_body * eigen_pose(given->origin);
    shape.link = link.name;
    if (has_extent(shape, description.source, element + kind)) {
      shapes.push_back(std::move(shape));
    } else {
      notes.push_back({RobotNote::Kind::kIgnored, element + kind, "a shape without extent is left out"});
    }
  };
  if (which == ShapeSource::kCollision) {
    for (const auto& collision : link.collision_array) add(collision, "<collision>");
  } else {
    for (const auto& visual : link.visual_array) add(visual, "<visual>");
  }
  return shapes;
}

}  // namespace robot_control
