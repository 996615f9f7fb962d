#include "log/bag/bag_reader.h"

#include "log/bag/read_bag.h"
#include "support/matchers.h"
#include "support/message_of.h"

namespace robot_control::tests {

TEST(ASoundBag, IsReadToItsLastMessage) {
  const MadeBag made = make_bag(3, 200);
  const BagOfBytes file(made.bytes);
  BagReader bag(file.path());
  EXPECT_EQ(bag.cut(), "");
  EXPECT_EQ(bag.messages(), 600U);
  EXPECT_EQ(read_all(bag), made.chunks);
  ASSERT_EQ(bag.connections().size(), 2U);
  EXPECT_EQ(bag.connections().at(1).topic, "/imu");
  EXPECT_EQ(bag.connections().at(1).type, "std_msgs/String");
  EXPECT_EQ(bag.chunks()[1].first_ns, made.chunks[1].front().time_ns);
  EXPECT_EQ(bag.chunks()[1].last_ns, made.chunks[1].back().time_ns);
}

TEST(ASoundBag, IsAnErrorIfItShrinksBetweenTwoReads) {
  const BagOfBytes file(make_bag(3, 100'000).bytes);
  BagReader bag(file.path());
  file.shorten(1000);
  EXPECT_THROW(read_all(bag), BagError);
}

TEST(ASoundBag, IsReadOnceWhereItIsReadWhileItIsChecked) {
  const MadeBag made = make_bag(3, 100'000);
  const BagOfBytes file(made.bytes);
  std::size_t chunks = 0;
  const auto compare = [&](BagReader& bag, const BagChunk& chunk) {
    file.shorten(0);
    EXPECT_EQ(read_chunk(bag, chunk), made.chunks[chunks++]) << "from memory";
  };
  EXPECT_THROW(BagReader(file.path(), compare), BagError);
  EXPECT_GE(chunks, 1U);
}

/// Each case has one contradiction: everything else in the bag agrees.
TEST(ASoundBag, IsRefusedWithByteAndFieldForOneContradiction) {
  const auto said = [&](const BagFlaw& flaw) { return refusal(make_bag(2, 20, flaw).bytes); };
  EXPECT_THAT(said({.start_in_list = 1}), HasSubstr("field start_time: contradicts the messages in the chunk"));
  EXPECT_THAT(said({.size_of_chunk = 1}), HasSubstr("field size: "));
  EXPECT_THAT(said({.index_pos = 1}), HasSubstr("field index_pos: the chunks end here"));
  EXPECT_THAT(said({.chunk_count = 1}), HasSubstr("field chunk_count: 3, but there are 2 chunks"));
  EXPECT_THAT(said({.connection_count = 1}), HasSubstr("field conn_count: 3, but there are 2 connections"));
  EXPECT_THAT(said({.other_type = "std_msgs/Bool"}), HasSubstr("another connection record 0 stands before"));
  EXPECT_THAT(said({.behind_stream = "x"}), HasSubstr("1 bytes stand behind the end of the compressed stream"));
  EXPECT_THAT(said({.compression = "bz2"}), HasSubstr("field compression: 'bz2' is none of a log; `rosbag compress"));
  EXPECT_EQ(said({}), "");
}

TEST(AForeignFile, IsRefusedInOneSentence) {
  EXPECT_THAT(refusal(""), HasSubstr("byte 0, field version: the file begins with ''"));
  EXPECT_THAT(refusal("time,left,right\n"), HasSubstr("begins with 'time,left,rig'"));
  EXPECT_THAT(refusal("#ROSBAG V1.2\n"), HasSubstr("instead of '#ROSBAG V2.0'"));
  EXPECT_THAT(refusal("#ROSBAG V2.0\n"), HasSubstr("byte 13, field header_len: 4 bytes, but the file ends after 0"));
  EXPECT_THAT(refusal("#ROSBAG V2.0\n" + std::string(100, '\xFF')), HasSubstr("field header_len: 4294967295 bytes"));
  EXPECT_THAT(refusal("#ROSBAG V2.0\n" + std::string(100, '\0')), HasSubstr("field op: is absent"));
}

TEST(AForeignFile, IsRefusedIfItIsNoRegularOne) {
  EXPECT_THROW(BagReader("/dev/zero"), std::runtime_error);
  EXPECT_THROW(BagReader("/nowhere.bag"), std::runtime_error);
}

TEST(AHeader, IsReadFieldByField) {
  const std::string bytes = bag_field("op", "\x02") + bag_field("conn", little_endian(7, 4));
  const BagHeader header(bytes, {.offset = 100});
  EXPECT_EQ(header.op(), BagOp::kMessage);
  EXPECT_EQ(header.u32("conn"), 7U);
  EXPECT_THROW(header.u32("op"), BagError);
  EXPECT_THROW(header.u64("conn"), BagError);
  EXPECT_THROW(header.time_ns("time"), BagError);
  EXPECT_THROW(header.text("topic"), BagError);
}

TEST(AHeader, IsRefusedAtTheByteOfABrokenField) {
  const auto said = [](const std::string& bytes) -> std::string {
    return message_of<BagError>([&] { const BagHeader header(bytes, {.offset = 100}); });
  };
  const std::string sound = bag_field("op", "\x02");  // 8 bytes
  EXPECT_THAT(said(sound + "xyz"), HasSubstr("byte 108, field field_len: the header ends within its 4 bytes"));
  EXPECT_THAT(said(sound + little_endian(999'999, 4) + "x="), HasSubstr("byte 108, field field_len: 999999 bytes"));
  EXPECT_THAT(said(sound + little_endian(3, 4) + "abc"), HasSubstr("byte 112, field 'abc': is no name=value"));
  EXPECT_THAT(said(sound + little_endian(3, 4) + "=bc"), HasSubstr("is no name=value"));
  EXPECT_THAT(said(sound + sound), HasSubstr("field 'op': stands in the header twice"));
  std::string many;
  for (int i = 0; i < 40; ++i) many += bag_field("f" + std::to_string(i), "");
  EXPECT_THAT(said(many), HasSubstr("too many fields"));
  EXPECT_EQ(said(sound), "");
}

}  // namespace robot_control::tests
