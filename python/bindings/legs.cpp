#include "bindings/legs.h"

#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <array>
#include <string>
#include <vector>

#include "machine/legs/leg_model.h"

namespace py = pybind11;

namespace robot_control {
namespace {

using AllAngles = Eigen::Matrix<double, kLegsJoints, 1>;

/// One row per leg.
using Feet = Eigen::Matrix<double, kLegs, 3, Eigen::RowMajor>;

LegAngles of_leg(const AllAngles& angles, std::size_t leg) {
  return angles.segment<3>(static_cast<Eigen::Index>(kLegJoints * leg));
}

Feet feet(const LegModel& robot, const AllAngles& angles) {
  Feet result;
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    result.row(static_cast<Eigen::Index>(leg)) = robot.legs[leg].kinematics.position(of_leg(angles, leg));
  }
  return result;
}

std::vector<Eigen::Matrix3d> jacobians(const LegModel& robot, const AllAngles& angles) {
  std::vector<Eigen::Matrix3d> result;
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    Eigen::Vector3d foot;
    result.push_back(robot.legs[leg].kinematics.jacobian(of_leg(angles, leg), foot));
  }
  return result;
}

py::tuple angles_of(const LegModel& robot, const Feet& wanted) {
  AllAngles angles;
  std::vector<std::string> reach;
  constexpr std::array<const char*, 3> kNames{"reached", "beyond reach", "beyond range"};
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const LegSolution solution =
        robot.legs[leg].kinematics.inverse(wanted.row(static_cast<Eigen::Index>(leg)).transpose());
    angles.segment<3>(static_cast<Eigen::Index>(kLegJoints * leg)) = solution.angles;
    reach.emplace_back(kNames[static_cast<std::size_t>(solution.reach)]);
  }
  return py::make_tuple(angles, reach);
}

}  // namespace

void bind_legs(py::module_& module) {
  py::class_<LegModel>(module, "LegModel")
      .def("forward", &feet, py::arg("angles"))
      .def("inverse", &angles_of, py::arg("feet"))
      .def("jacobian", &jacobians, py::arg("angles"))
      .def_property_readonly("joints", [](const LegModel& robot) {
        std::vector<std::string> names;
        for (const JointModel& joint : robot.joints) names.push_back(joint.name);
        return names;
      });
}

}  // namespace robot_control
