/// Every number of a frame has a name.

#include "log/replay/frame_fields.h"

#include <gtest/gtest.h>

#include <set>

namespace robot_control {
namespace {

template <class Plain>
std::set<std::string> names(std::size_t skipped) {
  constexpr std::size_t kWords = sizeof(Plain) / 8;
  std::set<std::string> all;
  const auto zero = std::bit_cast<std::array<std::uint64_t, kWords>>(Plain{});
  for (std::size_t word = skipped; word < kWords; ++word) {
    auto changed = zero;
    changed[word] ^= 1;
    const auto found = differences(Plain{}, std::bit_cast<Plain>(changed));
    EXPECT_EQ(found.size(), 1u) << "word " << word;
    for (const FieldDifference& each : found) EXPECT_TRUE(all.insert(each.field).second) << each.field << " twice";
  }
  return all;
}

constexpr std::size_t kHeadWords = sizeof(FrameHead) / 8;

TEST(FrameFields, NameEveryNumberOfAState) {
  const auto all = names<StateFrame>(kHeadWords);
  EXPECT_TRUE(all.contains("pose_covariance[35]"));
  EXPECT_TRUE(all.contains("skipped"));
}

TEST(FrameFields, NameEveryNumberOfACommand) {
  const auto all = names<CommandFrame>(kHeadWords);
  EXPECT_TRUE(all.contains("joints[31].effort"));
  EXPECT_TRUE(all.contains("silence_needed"));
}

TEST(FrameFields, NameEveryNumberOfAPermit) {
  const auto all = names<Permit>(kHeadWords);
  EXPECT_TRUE(all.contains("speed_limit"));
  EXPECT_TRUE(all.contains("evidence[7].limit"));
}

TEST(FrameFields, NameEveryNumberOfAGateReport) {
  EXPECT_TRUE(names<GateReport>(0).contains("refused"));
}

TEST(FrameFields, ShowRealAndWholeNumbers) {
  CommandFrame logged, replayed;
  replayed.joints[1] = {.mode = JointMode::kEffort, .effort = 0.5};
  const auto found = differences(logged, replayed);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].field, "joints[1].mode");
  EXPECT_EQ(found[0].replayed, "1");
  EXPECT_EQ(found[1].field, "joints[1].effort");
  EXPECT_EQ(found[1].replayed, "0.5");
}

}  // namespace
}  // namespace robot_control
