/// Four processes against the closed loop in one: the same numbers, bit for bit.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "simulation/closed_loop.h"
#include "support/log_table.h"
#include "support/processes/four_nodes.h"

namespace robot_control::tests {

constexpr std::uint64_t kCycles = 6000;
constexpr double kLockstepPatience = 120;  // s

/// Drives a curve, stops by e-stop, is reset and drives on.
struct Lockstep : ::testing::Test {
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
    parameters_.telemetry.record = RecordMode::kAlways;
    parameters_.plant.cycles = kCycles;
    robot_ = read_drive_train(load_description(parameters_.urdf), parameters_.robot);
  }
  ~Lockstep() override { std::filesystem::remove_all(folder_); }

  /// run.bag of four processes and a telemetry.
  LogTable four_processes(const std::string& name, ClockMode clock) {
    Parameters parameters = parameters_;
    parameters.loop.clock = clock;
    parameters.telemetry.directory = (folder_ / name).string();
    FourNodes(parameters, robot_, true).run(kLockstepPatience);
    return LogTable::of_bag(folder_ / name / "run.bag");
  }

  /// The same table of the loop in this process.
  LogTable one_process() {
    ClosedLoop loop(parameters_);
    LogTable table(robot_, parameters_.loop.period());
    for (std::uint64_t k = 0; k < kCycles; ++k) {
      loop.step();
      table.add(loop.row());
    }
    return table;
  }

  std::filesystem::path folder_;
  Parameters parameters_;
  DriveTrain robot_;
};

TEST_F(Lockstep, GivesTheSameNumbersUnderLoad) {
  const LogTable quiet = four_processes("quiet", ClockMode::kLockstep);
  const auto burn = [] {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    volatile double x = 1;
    while (x > 0) x = x * 1.5 / 1.5;
    return 0;
  };
  ChildProcess first(burn), second(burn), third(burn);
  const LogTable loaded = four_processes("loaded", ClockMode::kLockstep);
  EXPECT_EQ(LogTable::difference(quiet, loaded), "");
}

/// The row of the first tick that counted a held or missed command or a late permit, or that lacks a node's frame.
std::size_t first_miss(const LogTable& log) {
  const std::size_t counters[] = {log.place("held"), log.place("missed"), log.place("late_permits"),
                                  log.place("estimate_skipped")};
  const std::size_t frames[] = {log.place("gate_verdict"), log.place("estimate_x"), log.place("limited_linear"),
                                log.place("permit_action")};
  for (std::size_t row = 0; row < log.rows(); ++row) {
    for (const std::size_t counter : counters) {
      if (log.at(row, counter) != 0) return row;
    }
    for (const std::size_t frame : frames) {
      if (std::isnan(log.at(row, frame))) return row;
    }
  }
  return log.rows();
}

/// The number of rows at the beginning that are the same in all columns of `reference`.
std::size_t equal_rows(const LogTable& reference, const LogTable& other) {
  std::vector<std::size_t> places;
  for (const TraceColumn& column : reference.columns()) places.push_back(other.place(column.name));
  const std::size_t rows = std::min(reference.rows(), other.rows());
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (!LogTable::same(reference.at(row, i), other.at(row, places[i]))) return row;
    }
  }
  return rows;
}

/// A machine that stalls makes a frame late, and from there on the two runs may differ. Each wall-clock run is judged
/// up to its first missed or late frame. Runs are repeated until these stretches add up to 2 s.
TEST_F(Lockstep, AWallClockRunEqualsLockstepUntilTheFirstMissedCycle) {
  constexpr std::size_t kNeeded = 2000;  // rows
  constexpr int kMaxRuns = 40;           // a machine that stalls every 50 ms
  parameters_.plant.cycles = 2500;
  const LogTable lockstep = four_processes("lockstep", ClockMode::kLockstep);
  std::size_t judged = 0;
  for (int run = 0; run < kMaxRuns && judged < kNeeded; ++run) {
    const LogTable wall = four_processes("wall" + std::to_string(run), ClockMode::kWall);
    const std::size_t equal = equal_rows(lockstep, wall);
    const std::size_t miss = first_miss(wall);
    std::cout << "run " << run << ": " << equal << " equal rows, first miss in row " << miss << "\n";
    ASSERT_GE(equal + 1, miss) << "a frame that is late for tick k was due in cycle k-1";
    judged += std::min(equal, miss);
  }
  EXPECT_GE(judged, kNeeded);
}

}  // namespace robot_control::tests
