/// The extension module robot_control._mrpt: mapping and localisation in virtual time, for benchmarks and tests.

#include <pybind11/eigen.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>

#include "bindings/navigation/conversions.h"
#include "bindings/numpy_version.h"
#include "navigation/mapping/saved_map.h"
#include "navigation/mrpt/localizer.h"

namespace py = pybind11;

namespace robot_control::navigation {
namespace {

UncertainPose uncertain(const Pose& pose, const Eigen::Matrix3d& covariance) {
  return {planar_of(pose), covariance};
}

void bind_localizer(py::module_& module) {
  py::class_<Localizer>(module, "Localizer")
      .def(py::init([](const py::tuple& map, std::uint32_t seed) { return Localizer(grid_of(map), seed); }),
           py::arg("map"), py::arg("seed"))
      .def(
          "set_pose",
          [](Localizer& localizer, const Pose& pose, const Eigen::Matrix3d& covariance) {
            localizer.set_pose(uncertain(pose, covariance));
          },
          py::arg("pose"), py::arg("covariance"))
      .def("search", &Localizer::search)
      .def(
          "update",
          [](Localizer& localizer, const py::dict& scan, const Pose& sensor, const Pose& odometry,
             const Eigen::Matrix3d& covariance) {
            return localizer.update(scan_of(scan), planar_of(sensor), uncertain(odometry, covariance));
          },
          py::arg("scan"), py::arg("sensor"), py::arg("odometry"), py::arg("covariance"))
      .def_property_readonly("state", [](const Localizer& localizer) { return name_of(localizer.state()); })
      .def_property_readonly("reason", &Localizer::reason)
      .def_property_readonly("explained", &Localizer::explained)
      .def_property_readonly("pose", [](const Localizer& localizer) {
        const UncertainPose pose = localizer.pose();
        return py::make_tuple(pose_of(pose.mean), pose.covariance);
      });
}

}  // namespace
}  // namespace robot_control::navigation

PYBIND11_MODULE(_mrpt, module) {
  using namespace robot_control::navigation;
  robot_control::check_numpy_version();
  py::class_<Mapper>(module, "Mapper")
      .def(py::init<>())
      .def(py::init([](const py::tuple& map) { return Mapper(grid_of(map)); }), py::arg("map"))
      .def_static("load", &load_map, py::arg("path"))
      .def(
          "save", [](const Mapper& mapper, const std::string& path) { save_map(path, mapper); }, py::arg("path"))
      .def(
          "set_pose", [](Mapper& mapper, const Pose& pose) { mapper.set_pose(planar_of(pose)); }, py::arg("pose"))
      .def(
          "update",
          [](Mapper& mapper, const py::dict& scan, const Pose& sensor, const Pose& odometry,
             const Eigen::Matrix3d& covariance) {
            mapper.update(scan_of(scan), planar_of(sensor), uncertain(odometry, covariance));
          },
          py::arg("scan"), py::arg("sensor"), py::arg("odometry"), py::arg("covariance"))
      .def_property_readonly("pose", [](const Mapper& mapper) { return pose_of(mapper.pose()); })
      .def_property_readonly("anchor",
                             [](const Mapper& mapper) {
                               const Anchor anchor = mapper.anchor();
                               return py::make_tuple(anchor.node, pose_of(anchor.relative));
                             })
      .def_property_readonly("nodes",
                             [](const Mapper& mapper) {
                               std::vector<Pose> poses;
                               for (const GraphNode& node : mapper.graph().nodes) poses.push_back(pose_of(node.pose));
                               return poses;
                             })
      .def_property_readonly(
          "closed", [](const Mapper& mapper) { return std::ranges::count_if(mapper.graph().edges, &Edge::closes); })
      .def_property_readonly("matched", &Mapper::matched)
      .def_property_readonly("reason", &Mapper::reason)
      .def_property_readonly("map", [](const Mapper& mapper) { return numpy_of(mapper.grid()); });
  bind_localizer(module);
}
