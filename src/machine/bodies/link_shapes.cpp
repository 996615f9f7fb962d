#include "machine/bodies/link_shapes.h"

#include <cmath>
#include <filesystem>
#include <utility>

#include "machine/bodies/link_inertia.h"
#include "machine/description/mesh.h"
#include "machine/description/resource.h"
#include "machine/description/urdf_document.h"
#include "machine/description/wording.h"

namespace robot_control {
namespace {

/// A mesh does not exist.
class MissingMesh : public RobotError {
 public:
  using RobotError::RobotError;
};

std::vector<Eigen::Vector3d> mesh_points(const urdf::Mesh& mesh, const std::string& element,
                                         const RobotDescription& description, std::vector<RobotNote>& notes) {
  const Eigen::Vector3d scale(mesh.scale.x, mesh.scale.y, mesh.scale.z);
  if (!scale.allFinite() || (scale.array() == 0).any()) {
    refuse(description.source, element, "<mesh filename=\"" + mesh.filename + "\">: its scale is empty or zero",
           "Set scale=\"1 1 1\" for a mesh in metres, \"0.001 0.001 0.001\" for one in millimetres");
  }
  // A message that already begins with the URDF keeps it only once.
  const auto located = [&](const RobotError& error) {
    const std::string prefix = description.source + ": ";
    const std::string text = error.what();
    return prefix + element + ": " + (text.starts_with(prefix) ? text.substr(prefix.size()) : text);
  };
  std::filesystem::path path;
  try {
    path = resolve_resource(mesh.filename, description);
  } catch (const RobotError& error) {
    throw MissingMesh(located(error));
  }
  try {
    MeshCorners mesh_read = mesh_corners(path);
    for (Eigen::Vector3d& point : mesh_read.points) point = point.cwiseProduct(scale);
    if (mesh_read.not_finite > 0) {
      notes.push_back({RobotNote::Kind::kSuspicious, element,
                       "<mesh filename=\"" + mesh.filename + "\">: " + std::to_string(mesh_read.not_finite) +
                           " points are infinite or NaN: ignored"});
    }
    return std::move(mesh_read.points);
  } catch (const RobotError& error) {
    throw RobotError(located(error));
  }
}

Shape read_shape(const urdf::Geometry& geometry, const std::string& element, const RobotDescription& description,
                 std::vector<RobotNote>& notes) {
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
      shape.points = mesh_points(static_cast<const urdf::Mesh&>(geometry), element, description, notes);
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
      refuse(source, element, "a shape with a size of " + number(size) + " m", "Set sizes above zero");
    }
    extent = extent && size > 0;
  }
  return extent;
}

}  // namespace

std::vector<Shape> shapes_of(const urdf::Link& link, ShapeSource which, const Eigen::Isometry3d& in_body,
                             const RobotDescription& description, std::vector<RobotNote>& notes,
                             std::vector<std::string>* missing) {
  std::vector<Shape> shapes;
  const std::string element = link_element(link.name);
  const auto add_read = [&](const auto& given, const std::string& kind) {
    Shape shape = read_shape(*given->geometry, element + kind, description, notes);
    shape.in_body = in_body * eigen_pose(given->origin);
    shape.link = link.name;
    if (has_extent(shape, description.source, element + kind)) {
      shapes.push_back(std::move(shape));
    } else {
      notes.push_back({RobotNote::Kind::kIgnored, element + kind, "a shape without extent is ignored"});
    }
  };
  const auto add = [&](const auto& given, const std::string& kind) {
    if (!given || !given->geometry) return;
    try {
      add_read(given, kind);
    } catch (const MissingMesh& error) {
      if (missing == nullptr) throw;
      missing->push_back(error.what());
      notes.push_back({RobotNote::Kind::kSuspicious, element + kind,
                       "file not found: " + static_cast<const urdf::Mesh&>(*given->geometry).filename +
                           ": ignored, the robot stands without it"});
    }
  };
  if (which == ShapeSource::kCollision) {
    for (const auto& collision : link.collision_array) add(collision, "<collision>");
  } else {
    for (const auto& visual : link.visual_array) add(visual, "<visual>");
  }
  return shapes;
}

std::vector<std::string> missing_visuals(const urdf::Link& link, const RobotDescription& description) {
  std::vector<std::string> missing;
  for (const auto& visual : link.visual_array) {
    if (!visual || !visual->geometry || visual->geometry->type != urdf::Geometry::MESH) continue;
    const std::string& file = static_cast<const urdf::Mesh&>(*visual->geometry).filename;
    try {
      resolve_resource(file, description);
    } catch (const RobotError&) {
      missing.push_back(file);
    }
  }
  return missing;
}

}  // namespace robot_control
