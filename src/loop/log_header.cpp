#include "loop/log_header.h"

#include <gnu/libc-version.h>
#include <sys/utsname.h>

#include <algorithm>
#include <fstream>

#include "files/input_file.h"
#include "log/messages/message_types.h"
#include "machine/machine_model.h"

namespace robot_control {
namespace {

/// Model and flags of the first processor: "AMD Ryzen …; fpu vme …". Processors with equal flags compute equal bits.
std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  std::string model, flags;
  for (std::string line; std::getline(file, line) && (model.empty() || flags.empty());) {
    const std::string value = line.substr(std::min(line.size(), line.find(':') + 1));
    if (line.starts_with("model name")) model = value;
    if (line.starts_with("flags") || line.starts_with("Features")) flags = value;
  }
  return model + ";" + flags;
}

/// Empty if there is no such file: the log is written without it.
std::string text_of(const std::string& path, std::size_t max_size) {
  return path.empty() ? std::string() : read_input_file(path, max_size).text;
}

}  // namespace

LogHeader log_header(const Parameters& parameters, const Robot& composed) {
  const MachineModel& robot = composed.machine();
  const auto driven = std::ranges::count(robot.joints, JointRole::kDriven, &JointModel::role);
  LogHeader header{.robot = robot.name,
                   .kind = std::string(composed.kind()),
                   .contacts = robot.contacts,
                   .wheels = static_cast<std::uint32_t>(driven),
                   .period = parameters.loop.period(),
                   .clock = parameters.loop.clock == ClockMode::kWall ? "wall" : "lockstep",
                   .parameters = parameters_text(parameters),
                   .urdf = robot.urdf,
                   .scene = text_of(parameters.plant.scene, kMaxDescription),
                   .calibration = text_of(parameters.calibration_file, kMaxParameterFile),
                   .version = package_version(),
                   .build = package_build(),
                   .processor = processor(),
                   .libraries = std::string("glibc ") + gnu_get_libc_version()};
  for (const JointModel& joint : robot.joints) {
    header.joints.push_back(joint.name);
    header.roles.emplace_back(name_of(joint.role));
  }
  const RecordMode record = parameters.telemetry.record;
  header.record = record == RecordMode::kMotion ? "motion" : record == RecordMode::kAlways ? "always" : "request";
  utsname system{};
  if (uname(&system) == 0) {
    header.host = system.nodename;
    header.kernel = std::string(system.sysname) + " " + system.release + " " + system.version + " " + system.machine;
  }
  return header;
}

}  // namespace robot_control
