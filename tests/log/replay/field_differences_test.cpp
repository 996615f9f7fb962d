/// Every number of a frame has a name in the table of fields.

#include "log/replay/field_differences.h"

#include <gtest/gtest.h>

namespace robot_control::tests {

JoinedRow row_of(const EstimatorTrace& trace) {
  return {.laws = {.estimator = &trace}};
}
JoinedRow row_of(const ControllerTrace& trace) {
  return {.laws = {.controller = &trace}};
}
JoinedRow row_of(const MonitorTrace& trace) {
  return {.laws = {.monitor = &trace}};
}
JoinedRow row_of(const DriverTrace& trace) {
  return {.driver = &trace};
}

/// Changes each word of a member of a row behind the first `skipped`.
template <class Trace, class Plain>
std::set<std::string> names(Plain Trace::*member, std::size_t skipped) {
  constexpr std::size_t kWords = sizeof(Plain) / 8;
  std::set<std::string> all;
  const auto zero = std::bit_cast<std::array<std::uint64_t, kWords>>(Plain{});
  for (std::size_t word = skipped; word < kWords; ++word) {
    auto words = zero;
    words[word] ^= 1;
    Trace logged, changed;
    changed.*member = std::bit_cast<Plain>(words);
    const auto found = differences(row_of(logged), row_of(changed));
    EXPECT_EQ(found.size(), 1u) << "word " << word;
    for (const FieldDifference& each : found) EXPECT_TRUE(all.insert(each.field).second) << each.field << " twice";
  }
  return all;
}

constexpr std::size_t kHeadWords = sizeof(FrameHead) / 8;

TEST(FieldDifferences, NameEveryNumberOfAState) {
  const auto all = names(&EstimatorTrace::state, kHeadWords);
  EXPECT_TRUE(all.contains("pose_covariance[35]"));
  EXPECT_TRUE(all.contains("estimate_skipped"));
}

TEST(FieldDifferences, NameEveryNumberOfACommand) {
  const auto all = names(&ControllerTrace::command, kHeadWords);
  EXPECT_TRUE(all.contains("effort_command[31]"));
  EXPECT_TRUE(all.contains("stiffness_command[31]"));
  EXPECT_TRUE(all.contains("silence_needed"));
}

TEST(FieldDifferences, NameEveryNumberOfAPermit) {
  const auto all = names(&MonitorTrace::permit, kHeadWords);
  EXPECT_TRUE(all.contains("speed_limit"));
  EXPECT_TRUE(all.contains("evidence_limit[7]"));
}

TEST(FieldDifferences, NameEveryNumberOfAGateReport) {
  EXPECT_TRUE(names(&DriverTrace::gate, 0).contains("gate_refused"));
}

TEST(FieldDifferences, ShowRealAndWholeNumbers) {
  ControllerTrace logged, replayed;
  replayed.command.joints[1] = {.mode = JointMode::kEffort, .effort = 0.5};
  const auto found = differences(row_of(logged), row_of(replayed));
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].field, "effort_command[1]");
  EXPECT_EQ(found[0].replayed, "0.5");
  EXPECT_EQ(found[1].field, "mode_command[1]");
  EXPECT_EQ(found[1].replayed, "1");
}

}  // namespace robot_control::tests
