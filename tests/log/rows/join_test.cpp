#include "log/rows/join.h"

#include <random>

#include "log/rows/traces.h"
#include "support/matchers.h"

namespace robot_control::tests {

constexpr double kPeriod = 0.001;
constexpr std::size_t kWindow = 8;

/// "run:cycle parts", a part being d, e, c or m if the node has a frame.
std::string text_of(const JoinedRow& row) {
  return std::to_string(row.run) + ":" + std::to_string(row.cycle) + " " + (row.driver != nullptr ? "d" : "") +
         (row.estimator != nullptr ? "e" : "") + (row.controller != nullptr ? "c" : "") +
         (row.monitor != nullptr ? "m" : "");
}

void add(Join& join, std::uint64_t run, std::uint64_t cycle, const std::string& nodes) {
  for (const char node : nodes) {
    if (node == 'd') join.add(driver_row(run, cycle));
    if (node == 'e') join.add(estimator_row(run, cycle));
    if (node == 'c') join.add(controller_row(run, cycle));
    if (node == 'm') join.add(monitor_row(run, cycle));
  }
}

struct JoinTest : ::testing::Test {
  void cycle(std::uint64_t run, std::uint64_t k, const std::string& nodes = "decm") { add(join, run, k, nodes); }

  std::vector<std::string> rows;
  Join join{kPeriod, [this](const JoinedRow& row) { rows.push_back(text_of(row)); }, kWindow};
};

TEST_F(JoinTest, EmitsACycleAsSoonAsAllFourHaveIt) {
  cycle(7, 0, "dec");
  EXPECT_THAT(rows, IsEmpty());
  cycle(7, 0, "m");
  EXPECT_THAT(rows, ElementsAre("0:0 decm"));
}

TEST_F(JoinTest, JoinsRowsOfOneCycleOnly) {
  Join strict(kPeriod, [](const JoinedRow& row) {
    EXPECT_EQ(row.driver->sensors.head.cycle, row.cycle);
    EXPECT_EQ(row.estimator->state.head.cycle, row.cycle);
    EXPECT_EQ(row.controller->command.head.cycle, row.cycle);
    EXPECT_EQ(row.monitor->permit.head.cycle, row.cycle);
    EXPECT_EQ(row.time, static_cast<double>(row.cycle) * kPeriod);
  });
  for (const char* node : {"d", "e", "c", "m"}) {
    for (std::uint64_t k = 0; k < 100; ++k) add(strict, 1, k, node);
  }
  EXPECT_EQ(strict.counts().emitted, 100u);
}

TEST_F(JoinTest, WaitsForALateNodeWithinTheWindow) {
  for (std::uint64_t k = 0; k < kWindow; ++k) cycle(7, k, "dcm");
  EXPECT_THAT(rows, IsEmpty());
  for (std::uint64_t k = 0; k < kWindow; ++k) cycle(7, k, "e");
  EXPECT_EQ(rows.size(), kWindow);
  EXPECT_EQ(rows.back(), "0:7 decm");
}

TEST_F(JoinTest, EmitsBeyondASmallerWindowWhereThatIsAskedFor) {
  for (std::uint64_t k = 0; k < 5; ++k) cycle(7, k, "dcm");
  EXPECT_THAT(rows, IsEmpty());
  join.emit_beyond(3);
  EXPECT_THAT(rows, ElementsAre("0:0 dcm", "0:1 dcm"));
}

TEST_F(JoinTest, LeavesCellsEmptyWhereANodeMovedPastACycle) {
  cycle(7, 0);
  cycle(7, 1, "dcm");
  EXPECT_EQ(rows.size(), 1u);
  cycle(7, 2);
  EXPECT_THAT(rows, ElementsAre("0:0 decm", "0:1 dcm", "0:2 decm"));
  EXPECT_THAT(join.counts().absent, ElementsAre(0, 1, 0, 0));
}

TEST_F(JoinTest, KeepsARowWhoseDriverRowIsLost) {
  cycle(7, 0);
  cycle(7, 1, "ecm");
  cycle(7, 2);
  EXPECT_THAT(rows, ElementsAre("0:0 decm", "0:1 ecm", "0:2 decm"));
}

TEST_F(JoinTest, SkipsCyclesThatNobodyHas) {
  cycle(7, 0);
  cycle(7, 5);
  EXPECT_THAT(rows, ElementsAre("0:0 decm", "0:5 decm"));
}

TEST_F(JoinTest, ATokenLeavesCellsEmptyAndIsNoLoss) {
  cycle(7, 0, "dcm");
  EstimatorTrace token = estimator_row(7, 0);
  token.state.head.kind = FrameKind::kToken;
  join.add(token);
  EXPECT_THAT(rows, ElementsAre("0:0 dcm"));
  EXPECT_EQ(join.counts().absent[1], 0u);
}

TEST_F(JoinTest, ADeadNodeHoldsTheLogUpByTheWindowAtMost) {
  cycle(7, 0);
  for (std::uint64_t k = 1; k <= 100; ++k) cycle(7, k, "dem");
  EXPECT_EQ(rows.size(), 1 + 100 - kWindow);
  EXPECT_EQ(rows.back(), "0:92 dem");
  join.finish();
  EXPECT_EQ(rows.size(), 101u);
  EXPECT_EQ(join.counts().absent[2], 100u);
}

TEST_F(JoinTest, ANodeThatComesBackIsJoinedAgain) {
  cycle(7, 0);
  for (std::uint64_t k = 1; k < 50; ++k) cycle(7, k, "dem");
  for (std::uint64_t k = 50; k < 60; ++k) cycle(7, k);
  EXPECT_EQ(rows.back(), "0:59 decm");
  EXPECT_EQ(rows.size(), 60u);
  EXPECT_EQ(join.counts().late[2], 0u);
}

TEST_F(JoinTest, DropsAndCountsRowsOfCyclesAlreadyEmitted) {
  cycle(7, 0);
  for (std::uint64_t k = 1; k <= 20; ++k) cycle(7, k, "dem");
  cycle(7, 3, "c");
  EXPECT_EQ(join.counts().late[2], 1u);
  join.finish();
  EXPECT_EQ(rows.size(), 21u);
}

// A restarted node computes the present frame once more.
TEST_F(JoinTest, DropsTheSecondRowOfACycle) {
  cycle(7, 0);
  cycle(7, 1, "ee");
  cycle(7, 1, "dcm");
  EXPECT_THAT(rows, ElementsAre("0:0 decm", "0:1 decm"));
  EXPECT_EQ(join.counts().late[1], 1u);
}

TEST_F(JoinTest, GivesTheRowOfARestartedNodeThatAnswersACycleAgainAfterThatCycle) {
  std::vector<std::string> given;
  Join each(kPeriod, [&](const JoinedRow& row) {
    given.push_back(std::to_string(row.cycle) + (row.repeats ? " again" : ""));
    EXPECT_TRUE(!row.repeats || row.laws.controller->calls.law.process == 2);
  });
  ControllerTrace again = controller_row(1, 0);
  again.calls.law.process = 2;
  each.add(controller_row(1, 0));
  each.add(again);
  each.add(driver_row(1, 0));
  each.add(estimator_row(1, 0));
  EXPECT_THAT(given, IsEmpty());
  each.add(monitor_row(1, 0));
  EXPECT_THAT(given, ElementsAre("0", "0 again"));
  EXPECT_EQ(each.counts().late[2], 0u);
}

TEST_F(JoinTest, GivesTheRowsOfAMonitorThatStepsAgainWithoutAFrame) {
  std::vector<std::string> given;
  Join each(kPeriod, [&](const JoinedRow& row) {
    given.push_back(std::to_string(row.laws.monitor->calls.law.number) + (row.repeats ? " again" : ""));
  });
  MonitorTrace row = monitor_row(1, 0);
  for (row.calls.law.number = 0; row.calls.law.number < 3; ++row.calls.law.number) each.add(row);
  each.add(driver_row(1, 0));
  each.add(estimator_row(1, 0));
  each.add(controller_row(1, 0));
  EXPECT_THAT(given, ElementsAre("0", "1 again", "2 again"));
  EXPECT_EQ(each.counts().late[3], 0u);
}

TEST_F(JoinTest, NumbersRunsInTheirOrder) {
  cycle(50, 0);
  cycle(50, 1);
  cycle(90, 0);
  cycle(91, 0);
  EXPECT_THAT(rows, ElementsAre("0:0 decm", "0:1 decm", "1:0 decm", "2:0 decm"));
}

// The driver has begun a new run while the monitor still processes the old one.
TEST_F(JoinTest, FinishesARunBeforeTheNextWhenNodesSeeItAtDifferentTimes) {
  cycle(50, 0);
  cycle(50, 1, "dec");
  cycle(60, 0, "dec");
  cycle(60, 1, "de");
  EXPECT_EQ(rows.size(), 1u);
  cycle(50, 1, "m");
  cycle(60, 0, "m");
  EXPECT_THAT(rows, ElementsAre("0:0 decm", "0:1 decm", "1:0 decm"));
}

TEST_F(JoinTest, ANodeThatNeverSawTheEndOfARunDoesNotHoldTheNext) {
  cycle(50, 0);
  cycle(50, 1, "dec");
  cycle(60, 0);
  EXPECT_THAT(rows, ElementsAre("0:0 decm", "0:1 dec", "1:0 decm"));
}

TEST_F(JoinTest, KeepsAShortRunThatOneNodeMissed) {
  cycle(50, 0);
  cycle(60, 0, "dcm");
  cycle(70, 0);
  EXPECT_THAT(rows, ElementsAre("0:0 decm", "1:0 dcm", "2:0 decm"));
}

TEST_F(JoinTest, DropsRowsOfARunThatIsOver) {
  cycle(50, 0);
  for (std::uint64_t k = 0; k <= 2 * kWindow; ++k) cycle(60, k, "dec");
  cycle(50, 1, "m");
  EXPECT_EQ(join.counts().late[3], 1u);
  join.finish();
  EXPECT_EQ(rows.size(), 2 + 2 * kWindow);
}

TEST_F(JoinTest, FinishEmitsWhatWaits) {
  cycle(7, 0, "d");
  cycle(7, 1, "e");
  cycle(8, 0, "c");
  join.finish();
  EXPECT_THAT(rows, ElementsAre("0:0 d", "0:1 e", "1:0 c"));
}

TEST_F(JoinTest, FinishTwiceIsAsGoodAsOnce) {
  cycle(7, 0, "d");
  join.finish();
  join.finish();
  EXPECT_EQ(rows.size(), 1u);
}

// Rows of one node are lost and the nodes interleave within the window in any way. Every cycle that some node delivered
// is emitted once and in order, with exactly the delivered parts.
TEST_F(JoinTest, LosesNothingOverRandomInterleavings) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed);
    const std::string nodes = "decm";
    std::vector<std::string> expected;
    std::vector<std::vector<std::pair<std::uint64_t, std::uint64_t>>> pending(4);
    for (std::uint64_t run = 0; run < 4; ++run) {
      for (std::uint64_t k = 0; k < 20; ++k) {
        std::string parts;
        for (std::size_t node = 0; node < 4; ++node) {
          if (random() % 10 == 0) continue;
          parts += nodes[node];
          pending[node].emplace_back(run + 1, k);
        }
        if (!parts.empty()) expected.push_back(std::to_string(run) + ":" + std::to_string(k) + " " + parts);
      }
    }
    rows.clear();
    Join wide(kPeriod, [this](const JoinedRow& row) { rows.push_back(text_of(row)); });
    std::array<std::size_t, 4> next{};
    for (;;) {
      std::vector<std::size_t> open;
      for (std::size_t node = 0; node < 4; ++node) {
        if (next[node] < pending[node].size()) open.push_back(node);
      }
      if (open.empty()) break;
      const std::size_t node = open[random() % open.size()];
      const auto [run, k] = pending[node][next[node]++];
      add(wide, run, k, nodes.substr(node, 1));
    }
    wide.finish();
    ASSERT_EQ(rows, expected) << "seed " << seed;
  }
}

}  // namespace robot_control::tests
