/// The program between the driver of a Go2 and DDS. It alone loads CycloneDDS, which a hostile participant can end.
///
///   unitree_bridge DRIVE_FILE                 before the robot
///   unitree_bridge DRIVE_FILE --side robot    before a simulated robot

#include <csignal>
#include <iostream>
#include <string>
#include <vector>

#include "drivers/table/read_drive_file.h"
#include "drivers/unitree_go/bridge/bridge.h"
#include "files/given_path.h"
#include "rt/clock.h"

namespace {

volatile std::sig_atomic_t ends = 0;

}  // namespace

int main(int argc, char** argv) {
  using namespace robot_control;
  using unitree::go::DdsSide;
  std::vector<std::string> words;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word.find(":=") == std::string::npos) words.push_back(word);  // what roslaunch adds
  }
  const bool robot = words.size() == 3 && words[1] == "--side" && words[2] == "robot";
  if (words.size() != 1 && !robot) {
    std::cerr << "unitree_bridge: usage: unitree_bridge DRIVE_FILE [--side robot]\n";
    return 2;
  }
  std::signal(SIGINT, [](int) { ends = 1; });
  std::signal(SIGTERM, [](int) { ends = 1; });
  try {
    const auto file = read_drive_line(resolved_path(words[0]), "unitree_go");
    run_bridge(*file, robot ? DdsSide::kRobot : DdsSide::kController, &monotonic_ns, ends);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "unitree_bridge: " << error.what() << "\n";
    return 1;
  }
}
