/// Bags without a valid end.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "log/bag/read_bag.h"

namespace robot_control {
namespace {

using ::testing::HasSubstr;

constexpr std::size_t kChunks = 3, kMessages = 50;

class ACutBag : public ::testing::TestWithParam<BagCompression> {};

TEST_P(ACutBag, IsReadUpToItsLastSoundByteWhereverItIsCut) {
  const MadeBag made = make_bag(GetParam(), kChunks, kMessages);
  const std::size_t list = made.records[2 * kChunks].first;  // where the chunks end
  std::size_t last = 0;
  for (std::size_t size = made.records[0].first; size < made.bytes.size(); size += 7) {
    const BagOfBytes file(made.bytes.substr(0, size));
    BagReader bag(file.path());
    EXPECT_THAT(bag.cut(), HasSubstr("Read are " + std::to_string(bag.messages()) + " messages")) << size;
    std::size_t count = 0;
    const auto chunks = read_all(bag);
    for (std::size_t i = 0; i < chunks.size(); ++i) {
      for (std::size_t k = 0; k < chunks[i].size(); ++k, ++count) EXPECT_EQ(chunks[i][k], made.chunks[i][k]);
      if (i + 1 < chunks.size()) {
        EXPECT_EQ(chunks[i].size(), kMessages);
      }
    }
    EXPECT_EQ(count, bag.messages());
    EXPECT_GE(count, last) << "more of the file is not less of it";
    if (size >= list) {
      EXPECT_EQ(count, kChunks * kMessages);
    }
    last = count;
  }
}

INSTANTIATE_TEST_SUITE_P(Compressed, ACutBag,
                         ::testing::Values(BagCompression::kNone, BagCompression::kBz2, BagCompression::kLz4));

TEST(AKilledRecorder, LosesNoWholeMessageOfAnUncompressedChunk) {
  const MadeBag made = make_bag(BagCompression::kNone, 2, 50, {.unfinished = true});
  const BagOfBytes file(made.bytes.substr(0, made.bytes.size() - 5));
  BagReader bag(file.path());
  EXPECT_EQ(bag.messages(), 99U);
  EXPECT_THAT(bag.cut(), HasSubstr("index_pos is 0"));
  EXPECT_THAT(bag.cut(), HasSubstr("field data_len"));
  const auto chunks = read_all(bag);
  ASSERT_EQ(chunks.size(), 2U);
  EXPECT_EQ(chunks[0], made.chunks[0]);
  EXPECT_EQ(chunks[1].back(), made.chunks[1][48]);
}

TEST(AKilledRecorder, LeavesZerosThatEndTheReadablePart) {
  const MadeBag made = make_bag(BagCompression::kNone, 2, 50, {.unfinished = true});
  const BagOfBytes file(made.bytes + std::string(5000, '\0'));
  BagReader bag(file.path());
  EXPECT_EQ(bag.messages(), 100U);
  EXPECT_THAT(bag.cut(), HasSubstr("field op: is absent"));
}

TEST(ABagWithAnEnd, IsRefusedWhereItsMiddleIsMissing) {
  const MadeBag made = make_bag(BagCompression::kNone, 3, 50);
  std::string bytes = made.bytes;
  bytes.erase(made.records[2].first, made.records[2].second + made.records[3].second);  // the second chunk
  bytes += std::string(10'000, '\0');                                                   // so that it contains index_pos
  EXPECT_THAT(refusal(bytes), HasSubstr("field index_pos"));
}

}  // namespace
}  // namespace robot_control
