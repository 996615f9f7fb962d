#include "bindings/legs.h"

#include <pybind11/stl.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "machine/legs/leg_model.h"

namespace py = pybind11;

namespace robot_control {
namespace {

using namespace py::literals;

using Angles = std::array<double, kLegsJoints>;
using Feet = std::array<std::array<double, 3>, kLegs>;
using Jacobians = std::array<std::array<std::array<double, 3>, 3>, kLegs>;

std::array<double, 3> plain_row(const Eigen::Vector3d& vector) {
  return {vector.x(), vector.y(), vector.z()};
}

Feet feet(const LegModel& robot, const Angles& angles) {
  Feet result{};
  for (std::size_t leg = 0; leg < kLegs; ++leg)
    result[leg] = plain_row(robot.legs[leg].kinematics.position(LegModel::angles_of(angles, leg)));
  return result;
}

Jacobians jacobians(const LegModel& robot, const Angles& angles) {
  Jacobians result{};
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    Eigen::Vector3d foot = Eigen::Vector3d::Zero();
    const Eigen::Matrix3d columns = robot.legs[leg].kinematics.jacobian(LegModel::angles_of(angles, leg), foot);
    for (std::size_t axis = 0; axis < 3; ++axis)
      result[leg][axis] = plain_row(columns.row(static_cast<Eigen::Index>(axis)).transpose());
  }
  return result;
}

std::pair<Angles, std::vector<std::string>> angles_of(const LegModel& robot, const Feet& wanted) {
  constexpr std::array<const char*, 3> kNames{"reached", "beyond reach", "beyond range"};
  std::pair<Angles, std::vector<std::string>> result;
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const LegSolution solution = robot.legs[leg].kinematics.inverse({wanted[leg][0], wanted[leg][1], wanted[leg][2]});
    for (std::size_t i = 0; i < kLegJoints; ++i)
      result.first[kLegJoints * leg + i] = solution.angles[static_cast<Eigen::Index>(i)];
    result.second.emplace_back(kNames[static_cast<std::size_t>(solution.reach)]);
  }
  return result;
}

}  // namespace

void bind_legs(py::module_& module) {
  py::class_<LegModel>(module, "LegModel")
      .def("forward", &feet, "angles"_a)
      .def("inverse", &angles_of, "feet"_a)
      .def("jacobian", &jacobians, "angles"_a);
}

}  // namespace robot_control
