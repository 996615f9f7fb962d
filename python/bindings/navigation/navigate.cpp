/// The extension module robot_control._navigation: costmap, planner, guard and navigator in virtual time, for
/// benchmarks.

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "bindings/navigation/conversions.h"
#include "bindings/numpy_version.h"
#include "navigation/map_consistency.h"
#include "navigation/map_file.h"
#include "navigation/motion_clearance.h"
#include "navigation/moving_objects.h"
#include "navigation/navigator.h"
#include "navigation/scan_watch.h"

namespace py = pybind11;

namespace robot_control::navigation {
namespace {

std::vector<Pose> poses_of(const Plan& plan) {
  std::vector<Pose> poses;
  for (const PlanarPose& pose : plan.poses) poses.push_back({pose.x, pose.y, pose.yaw});
  return poses;
}

/// It does what the node navigate does with scan, place and goal, without ROS.
class Navigation {
 public:
  Navigation(const py::tuple& map, const std::string& urdf, bool unknown_is_free)
      : costmap_(grid_of(map), footprint_of_urdf(urdf, "the URDF"), unknown_is_free) {}

  /// `sensor`: on the base, which is at `place` in the map and at `odometry`. `moved`: m + rad so far. Returns why the
  /// laser, or map and place, cannot be trusted.
  std::string update(const py::dict& given, const Pose& sensor, const Pose& place, const Pose& odometry, double now,
                     double moved) {
    const Scan scan = scan_of(given);
    watch_.receive(scan, "laser", now, now, moved);
    consistency_.update(costmap_.insert(scan, composed(planar_of(place), planar_of(sensor)), now));
    const PlanarPose base = planar_of(odometry);
    seen_ = in_base_axes(objects_.update(scan, composed(base, planar_of(sensor)), now), base);
    costmap_.set_predicted(from_base_axes(predicted_points(seen_, costmap_.footprint()), planar_of(place)));
    const std::string problem = watch_.problem(now);
    return problem.empty() ? consistency_.problem() : problem;
  }
  bool silent(double now) const { return !watch_.problem(now).empty(); }
  double clearance_along(const py::dict& scan, const Pose& sensor, double linear, double angular) const {
    return navigation::clearance_along(costmap_.footprint(), points_of(scan_of(scan), planar_of(sensor)),
                                       {linear, angular}, seen_);
  }
  double distance(double x, double y) const { return costmap_.footprint().distance({x, y}); }
  py::tuple plan(const Pose& start, const Pose& goal, double now) {
    costmap_.update(now);
    const Plan plan = plan_path(costmap_, planar_of(start), planar_of(goal));
    return py::make_tuple(poses_of(plan), plan.length, plan.problem);
  }
  void begin(const Pose& goal, double now) { navigator_.begin(planar_of(goal), now); }

  /// `path`: "none", "active", "done" or why it failed. Returns state, reason, path or None, whether to stop.
  py::tuple step(double now, const std::string& problem, const Pose& pose, const std::string& path) {
    using State = PathReport::State;
    const State state = path == "none"     ? State::kNone
                        : path == "active" ? State::kActive
                        : path == "done"   ? State::kDone
                                           : State::kFailed;
    const NavigatorOutput out =
        navigator_.step({now, problem, consistency_.explanation(), "", planar_of(pose), {state, path}}, &costmap_);
    py::object way = py::none();
    if (out.path) way = py::cast(poses_of(*out.path));
    return py::make_tuple(name_of(out.state), out.reason, way, out.cancel);
  }

 private:
  Costmap costmap_;
  ScanWatch watch_;
  MovingObjects objects_;
  std::vector<MovingObject> seen_;
  MapConsistency consistency_;
  Navigator navigator_;
};

}  // namespace
}  // namespace robot_control::navigation

PYBIND11_MODULE(_navigation, module) {
  using namespace robot_control::navigation;
  robot_control::check_numpy_version();
  module.def(
      "read_map", [](const std::string& path) { return numpy_of(read_map(path)); }, py::arg("path"));
  module.def(
      "write_map", [](const std::string& path, const py::tuple& map) { write_map(path, grid_of(map)); },
      py::arg("path"), py::arg("map"));
  py::class_<Navigation>(module, "Navigation")
      .def(py::init<const py::tuple&, const std::string&, bool>(), py::arg("map"), py::arg("urdf"),
           py::arg("unknown_is_free") = false)
      .def("update", &Navigation::update, py::arg("scan"), py::arg("sensor"), py::arg("place"), py::arg("odometry"),
           py::arg("now"), py::arg("moved"))
      .def("silent", &Navigation::silent, py::arg("now"))
      .def("clearance_along", &Navigation::clearance_along, py::arg("scan"), py::arg("sensor"), py::arg("linear"),
           py::arg("angular"))
      .def("distance", &Navigation::distance, py::arg("x"), py::arg("y"))
      .def("plan", &Navigation::plan, py::arg("start"), py::arg("goal"), py::arg("now"))
      .def("begin", &Navigation::begin, py::arg("goal"), py::arg("now"))
      .def("step", &Navigation::step, py::arg("now"), py::arg("problem"), py::arg("pose"), py::arg("path"));
}
