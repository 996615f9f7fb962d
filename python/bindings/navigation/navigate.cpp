/// The extension module robot_control._navigation: costmap, planner, guard and navigator in virtual time, for
/// benchmarks.

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <array>
#include <map>
#include <optional>
#include <string>

#include "bindings/navigation/conversions.h"
#include "bindings/numpy_version.h"
#include "navigation/driven/driven_robot.h"
#include "navigation/goals/navigator.h"
#include "navigation/guard/collision_guard.h"
#include "navigation/guard/moving_outline.h"
#include "navigation/map_consistency.h"
#include "navigation/map_file.h"
#include "navigation/moving_objects.h"
#include "navigation/scan_watch.h"

namespace py = pybind11;

namespace robot_control::navigation {
namespace {

using Motion = std::array<double, 3>;  // linear, lateral [m/s], angular [rad/s]

PlanarMotion motion_of(const Motion& motion) {
  return {motion[0], motion[2], motion[1]};
}

std::vector<Pose> poses_of(const Plan& plan) {
  std::vector<Pose> poses;
  for (const PlanarPose& pose : plan.poses) poses.push_back({pose.x, pose.y, pose.yaw});
  return poses;
}

/// It does what the node navigate does with scan, place and goal, without ROS.
class Navigation {
 public:
  /// Without a map it has a window around the robot.
  Navigation(const std::optional<py::tuple>& map, const std::string& urdf)
      : robot_(driven_robot({urdf, "the URDF"}, Parameters())), costmap_(robot_.outline) {
    if (map) set_map(*map, false);
  }

  void set_map(const py::tuple& map, bool unknown_is_free) {
    const Zones zones = costmap_.zones();
    costmap_ = Costmap(grid_of(map), robot_.outline, unknown_is_free);
    costmap_.set_zones(zones);
    consistency_ = MapConsistency();
  }

  /// `mask`: 100 keep-out, 1 … 99 slower (zones.h).
  void set_zones(const py::tuple& mask) { costmap_.set_zones(Zones(grid_of(mask))); }
  double speed_limit(double x, double y) const {
    return costmap_.zones().speed_limit({x, y}, robot_.limits.forward, robot_.limits.linear_acceleration);
  }

  /// `sensor`: on the base, which is at `place` in the map and at `odometry`. `moved`: m + rad so far. Returns why the
  /// laser, or map and place, cannot be trusted.
  std::string update(const py::dict& given, const Pose& sensor, const Pose& place, const Pose& odometry, double now,
                     double moved) {
    const Scan scan = scan_of(given);
    watch_.receive(scan, "laser", now, now, moved);
    costmap_.centre_on({place[0], place[1]}, now);
    consistency_.update(costmap_.insert(scan, composed(planar_of(place), planar_of(sensor)), now));
    const PlanarPose base = planar_of(odometry);
    moving_ = composed(composed(planar_of(place), inverse(base)),
                       objects_.update(scan, composed(base, planar_of(sensor)), now));
    foresee(moving_, planar_of(place), costmap_);
    const std::string problem = watch_.problem(now);
    return problem.empty() ? consistency_.problem() : problem;
  }
  void block(const Pose& place, const std::array<double, 2>& obstacle, double now) {
    costmap_.block(composed(planar_of(place), std::vector<Point>{{obstacle[0], obstacle[1]}})[0], now);
  }
  double distance(double x, double y) const { return costmap_.footprint().distance({x, y}); }
  py::tuple plan(const Pose& start, const Pose& goal, double now) {
    costmap_.update(now);
    const Plan plan = plan_path(costmap_, planar_of(start), planar_of(goal));
    return py::make_tuple(poses_of(plan), plan.length, plan.problem);
  }
  void begin(const Pose& goal, double now) { navigator_.begin(planar_of(goal), now); }

  /// `motion`: linear, lateral [m/s], angular [rad/s]. `path`: "none", "active", "done" or why it failed. `speed`: of
  /// the goal, m/s. Returns state, reason, path or None, whether to stop, the requested motion or None, the path's
  /// speed.
  py::tuple step(double now, const std::string& problem, const Pose& pose, const Motion& motion,
                 const std::string& path, double speed) {
    using State = PathReport::State;
    const State state = path == "none"     ? State::kNone
                        : path == "active" ? State::kActive
                        : path == "done"   ? State::kDone
                                           : State::kFailed;
    const NavigatorOutput out = navigator_.step({now,
                                                 problem,
                                                 consistency_.explanation(),
                                                 "",
                                                 planar_of(pose),
                                                 motion_of(motion),
                                                 {state, path},
                                                 robot_.limits,
                                                 moving_,
                                                 speed},
                                                &costmap_);
    py::object way = py::none(), request = py::none();
    if (out.path) way = py::cast(poses_of(*out.path));
    if (out.request) request = py::make_tuple(out.request->linear, out.request->lateral, out.request->angular);
    return py::make_tuple(name_of(out.state), out.reason, way, out.cancel, request, out.speed);
  }

 private:
  DrivenRobot robot_;
  Costmap costmap_;
  ScanWatch watch_;
  MovingObjects objects_;
  MapConsistency consistency_;
  Navigator navigator_;
  std::vector<MovingObject> moving_;  // in the map
};

/// It does what the node collision_guard does with scans, odometry and requests, without ROS.
class Guard {
 public:
  explicit Guard(const std::string& urdf)
      : outline_(read_rigid_bodies({urdf, "the URDF"}), driven_robot({urdf, "the URDF"}, Parameters()).outline),
        guard_(outline_.footprint()) {}

  /// rad, by joint; `now` in s.
  void move_joints(const std::map<std::string, double>& positions, double now) {
    outline_.update(positions, now);
    guard_.set_footprint(outline_.footprint());
  }

  /// `moved`: m + rad so far.
  void insert(const std::string& laser, const py::dict& given, const Pose& mount, const Pose& base, double stamp,
              double now, double moved) {
    const Scan scan = scan_of(given);
    if (!watches_[laser].receive(scan, laser, stamp, now, moved).empty()) return;
    if (watches_[laser].problem(now).empty()) guard_.insert(laser, scan, planar_of(mount), planar_of(base), stamp);
  }

  /// Returns the clearance, why the lasers are not trusted, and what ends the way, in base axes, or None.
  py::tuple check(const Pose& base, const Motion& measured, const Motion& requested, double now) const {
    for (const auto& [name, watch] : watches_) {
      if (const std::string problem = watch.problem(now); !problem.empty())
        return py::make_tuple(0.0, problem, py::none());
    }
    const GuardVerdict verdict = guard_.check(planar_of(base), motion_of(measured), motion_of(requested), now);
    py::object obstacle = py::none();
    if (verdict.obstacle) obstacle = py::make_tuple(verdict.obstacle->x, verdict.obstacle->y);
    return py::make_tuple(verdict.clearance, verdict.problem, obstacle);
  }
  double distance(double x, double y) const { return guard_.footprint().distance({x, y}); }

 private:
  std::map<std::string, ScanWatch> watches_;
  MovingOutline outline_;
  CollisionGuard guard_;
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
      .def(py::init<const std::optional<py::tuple>&, const std::string&>(), py::arg("map"), py::arg("urdf"))
      .def("set_map", &Navigation::set_map, py::arg("map"), py::arg("unknown_is_free"))
      .def("set_zones", &Navigation::set_zones, py::arg("mask"))
      .def("speed_limit", &Navigation::speed_limit, py::arg("x"), py::arg("y"))
      .def("update", &Navigation::update, py::arg("scan"), py::arg("sensor"), py::arg("place"), py::arg("odometry"),
           py::arg("now"), py::arg("moved"))
      .def("block", &Navigation::block, py::arg("place"), py::arg("obstacle"), py::arg("now"))
      .def("distance", &Navigation::distance, py::arg("x"), py::arg("y"))
      .def("plan", &Navigation::plan, py::arg("start"), py::arg("goal"), py::arg("now"))
      .def("begin", &Navigation::begin, py::arg("goal"), py::arg("now"))
      .def("step", &Navigation::step, py::arg("now"), py::arg("problem"), py::arg("pose"), py::arg("motion"),
           py::arg("path"), py::arg("speed"));
  py::class_<Guard>(module, "Guard")
      .def(py::init<const std::string&>(), py::arg("urdf"))
      .def("move_joints", &Guard::move_joints, py::arg("positions"), py::arg("now"))
      .def("insert", &Guard::insert, py::arg("laser"), py::arg("scan"), py::arg("mount"), py::arg("base"),
           py::arg("stamp"), py::arg("now"), py::arg("moved"))
      .def("check", &Guard::check, py::arg("base"), py::arg("measured"), py::arg("requested"), py::arg("now"))
      .def("distance", &Guard::distance, py::arg("x"), py::arg("y"));
}
