#include "drivers/mujoco/model/mjcf_shapes.h"

#include <Eigen/Eigenvalues>
#include <locale>
#include <sstream>

#include "drivers/mujoco/model/true_robot.h"

namespace robot_control {
namespace {

constexpr double kMinThickness = 0.001;  // m

const char* const kContact =
    R"( contype="2" conaffinity="1" solmix="1e6" solref=".004 1" solimp=".99 .999 .001 .5 2" margin="0" gap="0" mass="0")";

const char* const kSliding = R"( condim="1" priority="1" friction="0 0 0")";

/// Returns the friction of a shape that stands on the ground: that of the ground, which is the larger of both.
std::string standing(const MujocoPlantParameters& parameters) {
  if (!parameters.ground_friction) return R"( condim="3" priority="0" friction="0 0 0")";
  return R"( condim="3" priority="1" friction=")" + mjcf_number(*parameters.ground_friction) + R"( 0 0")";
}

std::string rolling(const TrueWheel& wheel, const MujocoPlantParameters& parameters) {
  if (wheel.omni || parameters.tyre == TyreModel::kBrush) return kSliding;
  return standing(parameters);
}

// Returns the corners of a mesh that is at least kMinThickness thick along each principal direction.
std::vector<Eigen::Vector3d> thickened(std::vector<Eigen::Vector3d> corners) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& corner : corners) mean += corner / static_cast<double>(corners.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& corner : corners) scatter += (corner - mean) * (corner - mean).transpose();
  const Eigen::Matrix3d directions = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvectors();
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d direction = directions.col(axis);
    double lowest = 0, highest = 0;
    for (const Eigen::Vector3d& corner : corners) {
      lowest = std::min(lowest, direction.dot(corner - mean));
      highest = std::max(highest, direction.dot(corner - mean));
    }
    if (highest - lowest >= kMinThickness) continue;
    const std::size_t count = corners.size();
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::Vector3d corner = corners[i];
      corners[i] = corner + kMinThickness / 2 * direction;
      corners.push_back(corner - kMinThickness / 2 * direction);
    }
  }
  return corners;
}

}  // namespace

std::string mjcf_number(double value) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out.precision(17);
  out << value;
  return out.str();
}

std::string mjcf_numbers(const Eigen::Vector3d& values) {
  return mjcf_number(values.x()) + ' ' + mjcf_number(values.y()) + ' ' + mjcf_number(values.z());
}

std::string mjcf_pose(const Eigen::Isometry3d& frame) {
  const Eigen::Quaterniond q(frame.linear());
  return " pos=\"" + mjcf_numbers(frame.translation()) + "\" quat=\"" + mjcf_number(q.w()) + ' ' +
         mjcf_numbers(q.vec()) + '"';
}

std::string mjcf_shape(const std::string& name, const Shape& shape, const std::string& mesh, Grip grip,
                       const MujocoPlantParameters& parameters) {
  std::string geom = "<geom name=\"" + name + '"' + mjcf_pose(shape.in_body) + kContact +
                     (grip == Grip::kNone ? kSliding : standing(parameters));
  switch (shape.type) {
    case ShapeType::kSphere:
      geom += " type=\"sphere\" size=\"" + mjcf_number(shape.radius);
      break;
    case ShapeType::kCylinder:
      geom += " type=\"cylinder\" size=\"" + mjcf_number(shape.radius) + ' ' + mjcf_number(shape.length / 2);
      break;
    case ShapeType::kBox:
      geom += " type=\"box\" size=\"" + mjcf_numbers(shape.size / 2);
      break;
    case ShapeType::kMesh:
      geom += " type=\"mesh\" mesh=\"" + mesh;
      break;
  }
  return geom + "\"/>\n";
}

std::string mjcf_rolling_shape(const std::string& name, const Eigen::Isometry3d& frame, const TrueWheel& wheel,
                               const MujocoPlantParameters& parameters) {
  return "<geom name=\"" + name + '"' + mjcf_pose(frame) + kContact + rolling(wheel, parameters) +
         " type=\"ellipsoid\" size=\"" + mjcf_numbers({wheel.shape.radius, wheel.shape.radius, wheel.shape.width / 2}) +
         "\"/>\n";
}

std::string mjcf_mesh(const std::string& name, const std::vector<Eigen::Vector3d>& corners) {
  std::string element = "<mesh name=\"" + name + "\" scale=\"1 1 1\" vertex=\"";
  for (const Eigen::Vector3d& corner : thickened(corners)) element += mjcf_numbers(corner) + ' ';
  return element + "\"/>\n";
}

}  // namespace robot_control
