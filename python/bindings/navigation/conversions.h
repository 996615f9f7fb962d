#pragma once
/// Poses, scans and maps between Python and C++.

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <array>

#include "navigation/grid.h"
#include "navigation/scan.h"

namespace robot_control::navigation {

namespace py = pybind11;

using Pose = std::array<double, 3>;  // x m, y m, yaw rad

inline PlanarPose planar_of(const Pose& pose) {
  return {pose[0], pose[1], pose[2]};
}
inline Pose pose_of(const PlanarPose& pose) {
  return {pose.x, pose.y, pose.yaw};
}

/// Takes what ClosedLoop.scan gives.
inline Scan scan_of(const py::dict& given) {
  const auto number = [&](const char* name) { return given[name].cast<double>(); };
  return {.angle_min = number("angle_min"),
          .angle_increment = number("angle_increment"),
          .range_min = number("range_min"),
          .range_max = number("range_max"),
          .ranges = given["ranges"].cast<std::vector<float>>()};
}

/// Returns origin x, origin y [m], resolution [m] and cells (rows, columns).
inline py::tuple numpy_of(const Grid& grid) {
  py::array_t<std::int8_t> cells({grid.rows, grid.columns}, grid.cells.data());
  return py::make_tuple(grid.origin_x, grid.origin_y, grid.resolution, cells);
}

/// Takes what `numpy_of` gives.
inline Grid grid_of(const py::tuple& map) {
  const auto cells = map[3].cast<py::array_t<std::int8_t, py::array::c_style>>();
  return {.columns = static_cast<int>(cells.shape(1)),
          .rows = static_cast<int>(cells.shape(0)),
          .resolution = map[2].cast<double>(),
          .origin_x = map[0].cast<double>(),
          .origin_y = map[1].cast<double>(),
          .cells = {cells.data(), cells.data() + cells.size()}};
}

}  // namespace robot_control::navigation
