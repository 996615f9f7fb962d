#include "log/bag/bag_chunk.h"

#include "log/bag/read_bag.h"
#include "support/matchers.h"

namespace robot_control::tests {

/// Reads a chunk of these bytes that announces `size` bytes; returns its content, or the message of the refusal.
std::string said_of(const std::string& bytes, std::uint32_t size) {
  const BagOfBytes memory(bytes);
  BagFile file(memory.path());
  std::string content;
  try {
    read_bag_chunk(file, {.packed = static_cast<std::uint32_t>(bytes.size()), .size = size}, content);
  } catch (const BagError& error) {
    EXPECT_LE(content.capacity(), size + 100U);
    return error.what();
  }
  EXPECT_EQ(content.size(), size);
  return content;
}

TEST(ACompressedChunk, NeverInflatesBeyondWhatItSays) {
  const std::string stream = packed(std::string(50'000'000, '0'));
  EXPECT_EQ(said_of(stream, 50'000'000).size(), 50'000'000U);
  EXPECT_THAT(said_of(stream, 1000), HasSubstr("inflates to more than the 1000 bytes that it states"));
  EXPECT_THAT(said_of(stream, 0), HasSubstr("inflates to more than the 0 bytes"));
}

TEST(ACompressedChunk, IsRefusedIfItIsBroken) {
  const std::string content = "some content, some content, some content, some content";
  const auto size = static_cast<std::uint32_t>(content.size());
  const std::string stream = packed(content);
  EXPECT_EQ(said_of(stream, size), content);
  EXPECT_THAT(said_of(stream.substr(0, stream.size() - 3), size), HasSubstr("stream has no end"));
  EXPECT_THAT(said_of(stream, size + 1), HasSubstr("inflates to 54 bytes instead of the 55"));
  EXPECT_THAT(said_of(std::string(100, 'x'), 100), HasSubstr("is not a valid"));
  EXPECT_THAT(said_of("", 10), HasSubstr("the compressed stream has no end"));
  for (std::size_t at = 0; at < stream.size(); ++at) {
    std::string flipped = stream;
    flipped[at] = static_cast<char>(flipped[at] ^ 0x10);
    EXPECT_THAT(said_of(flipped, size), AnyOf(content, StartsWith("byte "))) << "byte " << at;
  }
}

TEST(AChunk, IsRefusedBeforeItInflatesWithoutBounds) {
  EXPECT_THAT(refusal(make_bag(1, 10, {.size_of_chunk = kMaxChunk}).bytes), HasSubstr("field size: 26843"));
}

}  // namespace robot_control::tests
