/// Bags without a valid end.

#include "log/bag/read_bag.h"
#include "support/matchers.h"

namespace robot_control::tests {

constexpr std::size_t kChunks = 3, kMessages = 50;

TEST(ACutBag, IsReadUpToItsLastSoundByteWhereverItIsCut) {
  const MadeBag made = make_bag(kChunks, kMessages);
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

TEST(AKilledWriter, LosesTheChunkThatIsNotWhole) {
  const MadeBag made = make_bag(2, 50, {.unfinished = true});
  const BagOfBytes whole(made.bytes), file(made.bytes.substr(0, made.bytes.size() - 5));
  EXPECT_EQ(BagReader(whole.path()).messages(), 100U);
  BagReader bag(file.path());
  EXPECT_THAT(bag.cut(), HasSubstr("index_pos is 0"));
  EXPECT_THAT(bag.cut(), HasSubstr("field data_len"));
  const auto chunks = read_all(bag);
  ASSERT_EQ(chunks.size(), 1U);
  EXPECT_EQ(chunks[0], made.chunks[0]);
}

TEST(AKilledWriter, LeavesZerosThatEndTheReadablePart) {
  const MadeBag made = make_bag(2, 50, {.unfinished = true});
  const BagOfBytes file(made.bytes + std::string(5000, '\0'));
  BagReader bag(file.path());
  EXPECT_EQ(bag.messages(), 100U);
  EXPECT_THAT(bag.cut(), HasSubstr("field op: is absent"));
}

/// Nothing else shows that it stands there twice.
TEST(AKilledWriter, HasWrittenNoChunkTwice) {
  const MadeBag made = make_bag(3, 50, {.unfinished = true});
  const std::size_t begin = made.records[2].first, end = made.records[4].first;
  std::string bytes = made.bytes;
  bytes.insert(end, bytes.substr(begin, end - begin));
  const BagOfBytes file(bytes);
  const BagReader bag(file.path());
  EXPECT_EQ(bag.messages(), 100U);
  EXPECT_THAT(bag.cut(), HasSubstr("field time: the chunk begins before the end of the previous chunk"));
}

TEST(ABagWithAnEnd, IsRefusedWhereItsMiddleIsMissing) {
  const MadeBag made = make_bag(3, 50);
  std::string bytes = made.bytes;
  bytes.erase(made.records[2].first, made.records[2].second + made.records[3].second);  // the second chunk
  bytes += std::string(10'000, '\0');                                                   // so that it contains index_pos
  EXPECT_THAT(refusal(bytes), HasSubstr("field index_pos"));
}

}  // namespace robot_control::tests
