#include "log/bag/bag_chunk.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "log/bag/read_bag.h"

namespace robot_control {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// Reads a chunk of these bytes that announces `size` bytes; returns its content, or the message of the refusal.
std::string said_of(const std::string& bytes, std::uint32_t size, BagCompression compression) {
  const BagOfBytes memory(bytes);
  BagFile file(memory.path());
  std::string content;
  try {
    read_bag_chunk(file, {.packed = static_cast<std::uint32_t>(bytes.size()), .size = size, .compression = compression},
                   content);
  } catch (const BagError& error) {
    EXPECT_LE(content.capacity(), size + 100U);
    return error.what();
  }
  EXPECT_EQ(content.size(), size);
  return content;
}

class ACompressedChunk : public ::testing::TestWithParam<BagCompression> {};

TEST_P(ACompressedChunk, NeverInflatesBeyondWhatItSays) {
  const std::string stream = packed(std::string(50'000'000, '0'), GetParam());
  EXPECT_EQ(said_of(stream, 50'000'000, GetParam()).size(), 50'000'000U);
  EXPECT_THAT(said_of(stream, 1000, GetParam()), HasSubstr("inflates to more than the 1000 bytes that it says"));
  EXPECT_THAT(said_of(stream, 0, GetParam()), HasSubstr("inflates to more than the 0 bytes"));
}

TEST_P(ACompressedChunk, ThatIsBrokenIsRefused) {
  const std::string content = "some content, some content, some content, some content";
  const auto size = static_cast<std::uint32_t>(content.size());
  const std::string stream = packed(content, GetParam());
  EXPECT_EQ(said_of(stream, size, GetParam()), content);
  EXPECT_THAT(said_of(stream.substr(0, stream.size() - 3), size, GetParam()), HasSubstr("stream has no end"));
  EXPECT_THAT(said_of(stream, size + 1, GetParam()), HasSubstr("inflates to 54 bytes instead of the 55"));
  EXPECT_THAT(said_of(std::string(100, 'x'), 100, GetParam()), HasSubstr("is no sound"));
  EXPECT_THAT(said_of("", 10, GetParam()), HasSubstr("the compressed stream has no end"));
  for (std::size_t at = 0; at < stream.size(); ++at) {
    std::string flipped = stream;
    flipped[at] = static_cast<char>(flipped[at] ^ 0x10);
    // Some bits of bz2's symbol map have no meaning.
    EXPECT_THAT(said_of(flipped, size, GetParam()), AnyOf(content, StartsWith("byte "))) << "byte " << at;
  }
}

INSTANTIATE_TEST_SUITE_P(As, ACompressedChunk, ::testing::Values(BagCompression::kBz2, BagCompression::kLz4));

TEST(AChunk, ThatWouldInflateWithoutBoundsIsRefusedBeforeIt) {
  EXPECT_THAT(refusal(make_bag(BagCompression::kBz2, 1, 10, {.size_of_chunk = kMaxChunk}).bytes),
              HasSubstr("with a chunk of 26843"));
  EXPECT_THAT(refusal(make_bag(BagCompression::kLz4, 2, 10, {.size_of_chunk = 40U << 20U}).bytes),
              HasSubstr("field size: "));
}

}  // namespace
}  // namespace robot_control
