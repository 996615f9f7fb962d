/// Virtual time is as fast as promised, judged against the bare physics engine of the same run.

#include <gtest/gtest.h>

#include <algorithm>

#include "support/processes/loop_speed.h"

namespace robot_control::tests {

// Promised: 60 × and 20 × real time on a quiet machine whose bare loop runs at 150 ×.
constexpr double kClosedLoopShare = 60.0 / 150.0;
constexpr double kFourNodesShare = 20.0 / 150.0;
constexpr std::uint64_t kTimedCycles = 10'000;
constexpr int kRounds = 5;  // rounds until one is good: a stall in favour of another process proves nothing

struct Speed : ::testing::Test {
  template <class Measure>
  double best_share(Measure measure, double wanted) {
    double best = 0;
    for (int round = 0; round < kRounds && best < wanted; ++round) {
      const double bare = bare_loop_speed(parameters_, robot_, kTimedCycles);
      best = std::max(best, measure() / bare);
    }
    return best;
  }

  Parameters parameters_ = read_parameters(std::string(PROJECT_DIRECTORY) + "/config/robot_params.yaml");
  DriveTrain robot_ = read_drive_train(load_description(parameters_.urdf), parameters_.robot);
};

TEST_F(Speed, TheLoopInOneProcessKeepsItsShareOfTheBareEngine) {
  EXPECT_GE(best_share([&] { return closed_loop_speed(parameters_, kTimedCycles); }, kClosedLoopShare),
            kClosedLoopShare);
}

TEST_F(Speed, FourProcessesInLockstepKeepTheirShareOfTheBareEngine) {
  EXPECT_GE(best_share([&] { return four_nodes_speed(parameters_, robot_, kTimedCycles); }, kFourNodesShare),
            kFourNodesShare);
}

}  // namespace robot_control::tests
