#include "machine/description/xacro.h"

#include <filesystem>

#include "files/given_path.h"
#include "files/input_file.h"
#include "files/message_text.h"
#include "machine/description/environment.h"
#include "machine/description/other_process.h"
#include "machine/description/robot_description.h"
#include "machine/description/wording.h"

namespace robot_control {
namespace {

namespace fs = std::filesystem;

constexpr int kNotInstalled = 69;  // python/robot_control/setup/expand_xacro.py
constexpr const char* kByHand = "or expand the file yourself if you trust it as a program: xacro FILE > robot.urdf";

std::string python() {
  if (std::string chosen = environment("ROBOT_CONTROL_XACRO_PYTHON"); !chosen.empty()) return chosen;
  std::error_code error;
  const std::string ours = ROBOT_CONTROL_PROJECT "/build/xacro/bin/python3";
  return fs::exists(ours, error) ? ours : "/usr/bin/python3";
}

/// Returns the sourced path of the package robot_control, followed by that of the sources.
std::string python_path() {
  const std::string sourced = environment("PYTHONPATH");
  return "PYTHONPATH=" + (sourced.empty() ? "" : sourced + ":") + ROBOT_CONTROL_PROJECT "/python";
}

}  // namespace

std::string expand_xacro(const std::string& path) {
  if (const std::string problem = input_file_problem(path, kMaxDescription); !problem.empty()) {
    throw RobotError(fit_for_message(file_error(path, problem)) + ". Give the path of an existing .xacro file.");
  }
  const std::string interpreter = python();
  const ProcessResult result =
      run_program({interpreter, "-P", "-m", "robot_control.setup.expand_xacro", fs::absolute(path).string()},
                  {python_path(), "PYTHONUTF8=1", "PYTHONDONTWRITEBYTECODE=1"}, kXacroSeconds);
  switch (result.end) {
    case ProcessResult::End::kNotStarted:
      refuse(path, "xacro", interpreter + " cannot be started",
             "Set ROBOT_CONTROL_XACRO_PYTHON to a Python that has xacro, " + std::string(kByHand));
    case ProcessResult::End::kEnded:
      refuse(path, "xacro",
             "it did not finish within " + std::to_string(kXacroSeconds) + " s, or its output has no end",
             "Check for a cycle of includes or macros, " + std::string(kByHand));
    case ProcessResult::End::kKilled:
      refuse(path, "xacro", "it was killed by signal " + std::to_string(result.code),
             "Restart the program, " + std::string(kByHand));
    case ProcessResult::End::kExited:
      break;
  }
  if (result.code == kNotInstalled) {
    refuse(path, "xacro", interpreter + " has no module xacro",
           "Run scripts/setup or `pip install xacro`, " + std::string(kByHand));
  }
  if (result.code != 0) {
    refuse(
        path, "xacro", on_one_line(result.errors),
        "Correct the file; set ROS_PACKAGE_PATH for $(find …), and defaults for its arguments; or give the URDF that "
        "its author expanded: `xacro FILE` runs the file as a program, without protection");
  }
  return result.output;
}

}  // namespace robot_control
