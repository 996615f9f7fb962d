/// Four processes give the same bytes as the closed loop in one.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "simulation/closed_loop.h"
#include "support/file_content.h"
#include "support/four_nodes.h"
#include "telemetry/columns.h"
#include "telemetry/csv_writer.h"

namespace robot_control {
namespace {

constexpr std::uint64_t kCycles = 6000;
constexpr double kLockstepPatience = 120;  // s

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

/// Drives a curve, stops by e-stop, is reset and drives on.
class Lockstep : public ::testing::Test {
 protected:
  Lockstep() : folder_(std::filesystem::temp_directory_path() / ("lockstep-" + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
    std::ofstream script(folder_ / "script.csv");
    script << "cycle,linear,angular,event\n"
              "1,0.5,0.2,\n1000,0.5,0.2,\n2000,-0.3,0.5,\n2500,,,e_stop\n2600,0,0,\n4000,,,e_stop_reset\n"
              "4100,0.8,0,\n5000,nan,0,\n";
    script.close();
    parameters_ = read_parameters(std::string(PROJECT_DIRECTORY) + "/config/robot_params.yaml",
                                  {{"robot.command_script", (folder_ / "script.csv").string(), "test"}});
    parameters_.loop.wait_for_nodes = true;
    parameters_.loop.wait_for_telemetry = true;
    parameters_.plant.cycles = kCycles;
    robot_ = read_robot(load_description(parameters_.urdf), parameters_.robot);
  }
  ~Lockstep() override { std::filesystem::remove_all(folder_); }

  /// run.csv of four processes and a telemetry.
  std::string four_processes(const std::string& name, ClockMode clock) {
    Parameters parameters = parameters_;
    parameters.loop.clock = clock;
    parameters.telemetry.directory = (folder_ / name).string();
    FourNodes(parameters, robot_, true).run(kLockstepPatience);
    return content(folder_ / name / "run.csv");
  }

  /// The same file, written by the loop in this process.
  std::string one_process() {
    std::vector<std::string> joints;
    for (const JointModel& joint : robot_.joints) joints.push_back(joint.name);
    const std::filesystem::path path = folder_ / "closed_loop.csv";
    CsvWriter writer(path.string(), log_columns(joints, false));
    ClosedLoop loop(parameters_);
    for (std::uint64_t k = 0; k < kCycles; ++k) {
      loop.step();
      writer.write(loop.row());
    }
    writer.close();
    return content(path);
  }

  std::filesystem::path folder_;
  Parameters parameters_;
  RobotModel robot_;
};

TEST_F(Lockstep, FourProcessesGiveTheBytesOfTheClosedLoop) {
  const std::string four = four_processes("four", ClockMode::kLockstep);
  const std::string one = one_process();
  EXPECT_EQ(split(four, '\n').size(), kCycles + 1) << "no row is lost";
  EXPECT_TRUE(four == one);
}

TEST_F(Lockstep, GivesTheSameBytesUnderLoad) {
  const std::string quiet = four_processes("quiet", ClockMode::kLockstep);
  const auto burn = [] {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    volatile double x = 1;
    while (x > 0) x = x * 1.5 / 1.5;
    return 0;
  };
  ChildProcess first(burn), second(burn), third(burn);
  const std::string loaded = four_processes("loaded", ClockMode::kLockstep);
  EXPECT_TRUE(quiet == loaded);
}

/// A log: header and rows, cells by column name.
class Log {
 public:
  explicit Log(const std::string& text) : lines_(split(text, '\n')), names_(split(lines_.at(0), ',')) {}

  const std::vector<std::string>& names() const { return names_; }
  std::size_t rows() const { return lines_.size() - 1; }
  std::vector<std::string> row(std::size_t index) const { return split(lines_.at(index + 1) + ",", ','); }
  std::size_t place(const std::string& name) const {
    const auto found = std::find(names_.begin(), names_.end(), name);
    EXPECT_NE(found, names_.end()) << name;
    return static_cast<std::size_t>(found - names_.begin());
  }

  /// Row of the first tick that counted a held or missed command or a late permit, or has an empty cell.
  std::size_t first_miss() const {
    const std::vector<std::size_t> counters{place("held"), place("missed"), place("late_permits"),
                                            place("estimate_skipped")};
    for (std::size_t index = 0; index < rows(); ++index) {
      const std::vector<std::string> cells = row(index);
      for (const std::size_t counter : counters) {
        if (cells.at(counter) != "0") return index;
      }
      if (std::find(cells.begin(), cells.end(), "") != cells.end()) return index;
    }
    return rows();
  }

 private:
  std::vector<std::string> lines_;
  std::vector<std::string> names_;
};

/// Rows at the beginning whose cells are the same in all columns of `reference`.
std::size_t equal_rows(const Log& reference, const Log& other) {
  std::vector<std::size_t> places;
  for (const std::string& name : reference.names()) places.push_back(other.place(name));
  for (std::size_t index = 0; index < std::min(reference.rows(), other.rows()); ++index) {
    const std::vector<std::string> expected = reference.row(index);
    const std::vector<std::string> cells = other.row(index);
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (cells.at(places[i]) != expected.at(i)) return index;
    }
  }
  return std::min(reference.rows(), other.rows());
}

/// A machine that stalls makes a frame late, and from there on the two runs may differ. Each wall-clock run is judged
/// up to its first missed or late frame. Runs are repeated until these stretches add up to 2 s.
TEST_F(Lockstep, AWallClockRunEqualsLockstepUntilTheFirstMissedCycle) {
  constexpr std::size_t kNeeded = 2000;  // rows
  constexpr int kMaxRuns = 40;           // a machine that stalls every 50 ms
  parameters_.plant.cycles = 2500;
  const Log lockstep(four_processes("lockstep", ClockMode::kLockstep));
  std::size_t judged = 0;
  for (int run = 0; run < kMaxRuns && judged < kNeeded; ++run) {
    const Log wall(four_processes("wall" + std::to_string(run), ClockMode::kWall));
    const std::size_t equal = equal_rows(lockstep, wall);
    const std::size_t miss = wall.first_miss();
    std::cout << "run " << run << ": " << equal << " equal rows, first miss in row " << miss << "\n";
    ASSERT_GE(equal + 1, miss) << "a frame that is late for tick k was due in cycle k-1";
    judged += std::min(equal, miss);
  }
  EXPECT_GE(judged, kNeeded);
}

}  // namespace
}  // namespace robot_control
