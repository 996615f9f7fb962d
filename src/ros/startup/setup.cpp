#include "ros/startup/setup.h"

#include <ros/master.h>
#include <ros/names.h>
#include <ros/package.h>
#include <ros/param.h>
#include <ros/this_node.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <sstream>

#include "bus/bus.h"
#include "files/given_path.h"
#include "loop/latch_file.h"
#include "robots/robot_kind.h"
#include "ros/startup/description.h"
#include "ros/startup/overlays.h"
#include "signals/robot_kinds.h"

namespace robot_control {
namespace {

std::string installed_config() {
  return ros::package::getPath("robot_control") + "/config/robot_params.yaml";
}

/// Keys of a block that launch files set from their arguments; roslaunch prints them.
constexpr const char* kSetByLaunch =
    "driver drives urdf kind clock command_script bus wait_for_nodes wait_for_telemetry latch_file directory "
    "record black_box clearance scene seed cycles terrain.kind laser.rate simulated_laser map map_frame initial_pose "
    "speed unknown_is_free zones";

constexpr const char* kYamlPath = "the path of a YAML file";

XmlRpc::XmlRpcValue on_server(const std::string& name) {
  XmlRpc::XmlRpcValue value;
  ros::param::get(name, value);
  return value;
}

std::string server_text(const std::string& name, const std::string& what) {
  return text_parameter(on_server(name), name, what);
}

/// Replaces the paths that this node reads from the server by resolved ones, so that every reader finds the same files.
void resolve_server_paths() {
  for (const char* name :
       {"robot/urdf", "robot/drives", "robot/command_script", "~config", "~urdf", "~drives", "~scene",
        "~calibration_file", "~command_sources", "~directory", "~latch_file", "~map", "~zones"}) {
    XmlRpc::XmlRpcValue value = on_server(ros::names::resolve(name));
    if (value.getType() != XmlRpc::XmlRpcValue::TypeString) continue;
    const std::string& given = value;
    const std::string path = resolved_path(given);
    if (path != given) ros::param::set(name, path);
  }
}

/// Returns `~config`, whose file is laid over the installed one, else the path of the installed file.
std::string config_path() {
  const std::string path = server_text(ros::names::resolve("~config"), kYamlPath);
  return path.empty() ? installed_config() : path;
}

void append(std::vector<Overlay>& overlays, const std::string& name, const std::string& block,
            const std::vector<std::string>& ignored = {}) {
  const std::string resolved = ros::names::resolve(name);
  const std::vector<Overlay> found = overlays_of(on_server(resolved), block, resolved, ignored);
  overlays.insert(overlays.end(), found.begin(), found.end());
}

std::vector<Overlay> server_overlays(const std::string& node) {
  std::vector<Overlay> overlays;
  append(overlays, "robot", "robot");
  append(overlays, ros::this_node::getName(), node, {"config", "urdf", "driver", "drives"});
  append(overlays, "~urdf", "robot.urdf");
  append(overlays, "~driver", "robot.driver");
  append(overlays, "~drives", "robot.drives");
  return overlays;
}

RobotDescription description(const Parameters& parameters, const std::vector<Overlay>& overlays, std::string& unread) {
  const std::string name = ros::names::resolve("robot_description");
  const std::string published = server_text(name, "the text of a URDF");
  std::string asked_for;  // the last overlay is in force
  for (const Overlay& overlay : overlays) {
    if (overlay.path == "robot.urdf") asked_for = overlay.origin;
  }
  RobotDescription chosen = chosen_description(parameters, !asked_for.empty(), published, name);
  if (asked_for == ros::names::resolve("robot/urdf")) unread = unread_description(chosen, published, name, asked_for);
  return chosen;
}

void add(std::string& problems, const std::string& problem) {
  if (problem.empty()) return;
  if (!problems.empty()) problems += '\n';
  problems += problem;
}

}  // namespace

std::string clock_problem(ClockMode clock, bool use_sim_time) {
  if (clock == ClockMode::kWall && use_sim_time) {
    return "robot.clock is wall, but /use_sim_time is true, perhaps from an earlier run: "
           "run `rosparam set /use_sim_time false`, or set robot.clock to lockstep";
  }
  if (clock == ClockMode::kLockstep && !use_sim_time) {
    return "robot.clock is lockstep, but /use_sim_time is not true: run `rosparam set /use_sim_time true` "
           "before the nodes are started (sim.launch clock:=lockstep does), or set robot.clock to wall; if an "
           "earlier launch left robot/clock on the parameter server: `rosparam delete /robot/clock`";
  }
  return "";
}

namespace {

std::string host_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unknown";
}

/// Returns the problem if `node` is the controller of another kind of robot.
std::string other_controller(const std::string& node, const MachineModel& machine) {
  const MachineKind kind = kind_of(machine);
  const std::string own(names_of_kind(name_of(kind)).controller);
  const bool controls = std::ranges::count(kKinds, node, &KindNames::controller) != 0;
  if (!controls || node == own) return "";
  const bool legs = kind == MachineKind::kOnLegs;
  return "robot '" + machine.name + "' of " + machine.source + " is on " + (legs ? "legs" : "wheels") + ", and " +
         node + " controls robots on " + (legs ? "wheels" : "legs") + ": start " + own +
         " instead, as robot.launch and sim.launch do";
}

void read_machine(const std::string& node, const std::vector<Overlay>& overlays, Setup& setup, std::string& problems) {
  try {
    const RobotDescription chosen = description(setup.parameters, overlays, setup.unread_description);
    setup.parameters = limited_by_drives(setup.parameters, chosen);
    setup.machine = read_robot(chosen, setup.parameters);
    std::string& base_frame = setup.parameters.report.base_frame;
    if (base_frame.empty()) base_frame = setup.machine->base_link;
    add(problems, other_controller(node, *setup.machine));
  } catch (const RobotError& error) {
    add(problems, error.what());
  } catch (const ParameterError& error) {
    add(problems, error.what());
  }
}

void fill_setup(const std::string& node, bool in_loop, Setup& setup) {
  std::string path;
  std::vector<Overlay> overlays;
  bool use_sim_time = false;
  try {
    resolve_server_paths();
    path = config_path();
    overlays = server_overlays(node);
    use_sim_time = truth_parameter(on_server("/use_sim_time"), "/use_sim_time");
  } catch (const ParameterError& error) {
    throw SetupError(error.what());
  }
  setup.overrides = override_lines(overlays, path);
  std::istringstream set_by_launch(kSetByLaunch);
  setup.unexpected_overrides = override_lines(overlays, path, {std::istream_iterator<std::string>(set_by_launch), {}});
  std::string problems;
  try {
    setup.parameters = read_parameters(path, overlays, installed_config());
  } catch (const ParameterError& error) {
    throw SetupError(error.what());  // without parameters nothing else can be checked
  }
  if (in_loop) {
    add(problems, clock_problem(setup.parameters.loop.clock, use_sim_time));
    read_machine(node, overlays, setup, problems);
  }
  if (!problems.empty()) throw SetupError(problems);
  // Each namespace has a folder of its own, so that two robots never write to one file.
  std::string& directory = setup.parameters.telemetry.directory;
  directory =
      (directory.empty() ? caller_folder().string() : resolved_path(directory)) + ros::this_node::getNamespace();
  if (setup.machine != nullptr) {
    setup.parameters.latch_file = latch_path(resolved_path(setup.parameters.latch_file), host_name(),
                                             ros::this_node::getNamespace(), *setup.machine);
  }
  setup.bus = setup.parameters.loop.bus;
  if (setup.bus.empty()) setup.bus = bus_name(ros::master::getURI(), ros::this_node::getNamespace());
}

}  // namespace

Parameters parameters_of(Role role) {
  const std::string node(program_of(role));
  std::vector<Overlay> overlays;
  append(overlays, "robot", "robot");
  append(overlays, node, node, {"config", "urdf", "driver", "drives"});
  std::string path = resolved_path(server_text(ros::names::resolve(node + "/config"), kYamlPath));
  if (path.empty()) path = config_path();
  return read_parameters(path, overlays, installed_config());
}

Setup read_setup(const std::string& node, bool in_loop) {
  Setup setup;
  try {
    fill_setup(node, in_loop, setup);
  } catch (const SetupError& error) {
    std::string text = error.what();
    for (const std::string& line : setup.overrides) text += "\n  " + line;
    throw SetupError(text);
  }
  return setup;
}

}  // namespace robot_control
