#include "bus/bus.h"

#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

#include "support/bus/scoped_bus.h"
#include "support/bus/test_frame.h"
#include "support/file_content.h"
#include "support/matchers.h"
#include "support/message_of.h"

namespace robot_control::tests {

using Frames = LatestFrames<TestFrame>;

struct WideFrame {
  FrameHead head;
  std::array<std::uint64_t, 200> values{};
};

struct Row {
  std::uint64_t number = 0;
};

struct BusTest : testing::Test {
  std::string file(const std::string& channel = ChannelNames::kState) const {
    return "/dev/shm" + bus_object_name(bus_.name(), channel);
  }
  std::string write_error() const {
    return message_of<BusError>([&] { OwnedChannel<Frames>(bus_.name(), ChannelNames::kState); });
  }
  /// Puts a file of this user in the channel's place.
  void plant(const std::string& content) const {
    unlink(file().c_str());
    std::ofstream(file(), std::ios::binary) << content;
    chmod(file().c_str(), 0600);
  }
  /// An object of another layout in the channel's place.
  OwnedChannel<LatestFrames<WideFrame>> wide() const { return {bus_.name(), ChannelNames::kState}; }

  static void publish(const OwnedChannel<Frames>& channel, std::uint64_t cycle) {
    TestFrame frame = test_frame(7, cycle);
    FrameWriter<TestFrame>(channel.memory()).publish(frame);
  }

  ScopedBus bus_;
  ForeignChannel<Frames> reader_{bus_.name(), ChannelNames::kState};
  TestFrame found_;
};

// ---------------------------------------------------------------- names

TEST(BusName, Is16HexDigits) {
  EXPECT_THAT(bus_name("http://localhost:11311", "/"), testing::MatchesRegex("[0-9a-f]{16}"));
}

TEST(BusName, DependsOnThePortNotOnTheHost) {
  EXPECT_EQ(bus_name("http://localhost:11311", "/"), bus_name("http://10.0.0.1:11311/", "/"));
  EXPECT_NE(bus_name("http://localhost:11311", "/"), bus_name("http://localhost:11312", "/"));
}

TEST(BusName, TakesPort11311WhereTheUriHasNone) {
  EXPECT_EQ(bus_name("http://localhost", ""), bus_name("http://localhost:11311/", "/"));
  EXPECT_EQ(bus_name("", ""), bus_name("http://localhost:11311", "/"));
  EXPECT_EQ(bus_name("http://[::1]", ""), bus_name("http://[::1]:11311", ""));
}

TEST(BusName, DependsOnTheNamespaceHoweverItIsWritten) {
  const std::string second = bus_name("http://localhost:11311", "/robot2");
  EXPECT_EQ(second, bus_name("http://localhost:11311", "robot2"));
  EXPECT_EQ(second, bus_name("http://localhost:11311", "/robot2/"));
  EXPECT_NE(second, bus_name("http://localhost:11311", "/"));
  EXPECT_NE(second, bus_name("http://localhost:11311", "/robot3"));
}

TEST(BusObjectName, NamesUserBusAndChannel) {
  EXPECT_EQ(bus_object_name("b", "state"), "/robot_control." + std::to_string(geteuid()) + ".b.state");
}

TEST(BusObjectName, RefusesWhatIsNoFileName) {
  for (const std::string& bus : {std::string(), std::string("a/b"), std::string("a b"), std::string(300, 'x')}) {
    EXPECT_THAT(message_of<BusError>([&] { bus_object_name(bus, "state"); }), HasSubstr("parameter 'bus'")) << bus;
  }
}

// ---------------------------------------------------------------- one writer

TEST_F(BusTest, AReaderFindsNothingBeforeTheWriterHasMadeIt) {
  EXPECT_FALSE(reader_.poll());
  EXPECT_EQ(reader_.memory(), nullptr);
  EXPECT_FALSE(reader_.locked());
  EXPECT_EQ(reader_.obstacle(), "does not exist yet");
}

TEST_F(BusTest, CarriesFramesFromWriterToReader) {
  const OwnedChannel<Frames> writer(bus_.name(), ChannelNames::kState);
  EXPECT_TRUE(reader_.poll());
  EXPECT_FALSE(reader_.poll());  // nothing changed
  EXPECT_EQ(reader_.obstacle(), "");
  EXPECT_TRUE(reader_.locked());
  publish(writer, 5);
  ASSERT_EQ(FrameReader<TestFrame>(reader_.memory()).newest(found_), Lookup::kFrame);
  EXPECT_EQ(found_.head.cycle, 5u);
}

TEST_F(BusTest, CarriesRingsAndPositions) {
  const OwnedChannel<Ring<Row>> ring(bus_.name(), "trace_plant");
  const OwnedChannel<RingPositions> positions(bus_.name(), ChannelNames::kTraceRead);
  ForeignChannel<Ring<Row>> ring_view(bus_.name(), "trace_plant");
  ForeignChannel<RingPositions> positions_view(bus_.name(), ChannelNames::kTraceRead);
  ASSERT_TRUE(ring_view.poll());
  ASSERT_TRUE(positions_view.poll());
  RingReader<Row> reader(ring_view.memory());
  RingWriter<Row>(ring.memory()).append({42}, nullptr);
  Row row;
  ASSERT_TRUE(reader.read(row));
  EXPECT_EQ(row.number, 42u);
  positions.memory()->read[2].store(9);
  EXPECT_EQ(positions_view.memory()->read[2].load(), 9u);
}

TEST_F(BusTest, ReservesItsSpace) {
  const OwnedChannel<Frames> writer(bus_.name(), ChannelNames::kState);
  struct stat status {};
  ASSERT_EQ(stat(file().c_str(), &status), 0);
  EXPECT_EQ(status.st_size, static_cast<off_t>(sizeof(Frames)));
  EXPECT_GE(status.st_blocks * 512, status.st_size);
}

TEST_F(BusTest, ASecondWriterIsRefusedWhileTheFirstLives) {
  const OwnedChannel<Frames> first(bus_.name(), ChannelNames::kState);
  publish(first, 5);
  const std::string error = write_error();
  EXPECT_THAT(error, HasSubstr("channel 'state'"));
  EXPECT_THAT(error, HasSubstr(file()));
  EXPECT_THAT(error, HasSubstr("second instance"));
  EXPECT_THAT(error, HasSubstr("remedy: stop the first instance"));
  ASSERT_TRUE(reader_.poll());  // the first is not disturbed
  EXPECT_TRUE(reader_.locked());
  EXPECT_EQ(FrameReader<TestFrame>(reader_.memory()).newest(found_), Lookup::kFrame);
}

TEST_F(BusTest, OtherChannelsAndOtherBusesAreFree) {
  const ScopedBus other;
  const OwnedChannel<Frames> first(bus_.name(), ChannelNames::kState);
  EXPECT_NO_THROW(OwnedChannel<Frames>(bus_.name(), ChannelNames::kCommand));
  EXPECT_NO_THROW(OwnedChannel<Frames>(other.name(), ChannelNames::kState));
}

TEST_F(BusTest, ATakeOverResetsWhatTheWriterReportsOfItself) {
  {
    const OwnedChannel<Frames> first(bus_.name(), ChannelNames::kState);
    attach_to_run(first.memory()->head, 7);
    announce_robot(first.memory()->head, 9, "a.urdf");
  }
  const OwnedChannel<Frames> second(bus_.name(), ChannelNames::kState);
  EXPECT_EQ(attached_run(second.memory()->head), 0u);
  EXPECT_EQ(announced_robot(second.memory()->head).hash, 0u);
}

TEST_F(BusTest, AReaderSeesThatTheWriterIsGoneAndKeepsItsMapping) {
  {
    const OwnedChannel<Frames> writer(bus_.name(), ChannelNames::kState);
    publish(writer, 5);
    ASSERT_TRUE(reader_.poll());
  }
  EXPECT_FALSE(reader_.poll());
  EXPECT_FALSE(reader_.locked());
  EXPECT_EQ(FrameReader<TestFrame>(reader_.memory()).newest(found_), Lookup::kFrame);
}

// ---------------------------------------------------------------- leftovers

TEST_F(BusTest, AnUnlockedLeftoverOfAnotherLayoutIsRetiredAndRecreated) {
  ForeignChannel<LatestFrames<WideFrame>> old_reader(bus_.name(), ChannelNames::kState);
  wide();
  ASSERT_TRUE(old_reader.poll());
  const OwnedChannel<Frames> writer(bus_.name(), ChannelNames::kState);
  EXPECT_EQ(old_reader.memory()->head.retired.load(), 1u);
  EXPECT_TRUE(reader_.poll());
}

TEST_F(BusTest, ALockedObjectOfAnotherLayoutIsAnErrorForWriterAndReader) {
  const auto other = wide();
  EXPECT_THAT(write_error(), HasSubstr("its object has another layout"));
  EXPECT_THAT(message_of<BusError>([&] { reader_.poll(); }), HasSubstr("all nodes must be of one build"));
  EXPECT_EQ(other.memory()->head.retired.load(), 0u);  // this object belongs to another writer
}

TEST_F(BusTest, AReaderWaitsOutAnUnlockedLeftoverOfAnotherLayout) {
  wide();
  EXPECT_FALSE(reader_.poll());
  EXPECT_EQ(reader_.obstacle(), "has another layout");
  const OwnedChannel<Frames> writer(bus_.name(), ChannelNames::kState);
  EXPECT_TRUE(reader_.poll());
}

TEST_F(BusTest, AnotherLayoutVersionIsAnotherLayout) {
  { OwnedChannel<Frames>(bus_.name(), ChannelNames::kState).memory()->head.layout_version = kLayoutVersion + 1; }
  EXPECT_FALSE(reader_.poll());
  EXPECT_EQ(reader_.obstacle(), "has another layout");
}

TEST_F(BusTest, AReaderMapsTheSuccessorOfARetiredObjectAndTheOldMappingStaysValid) {
  {
    const OwnedChannel<Frames> writer(bus_.name(), ChannelNames::kState);
    publish(writer, 5);
    ASSERT_TRUE(reader_.poll());
    writer.memory()->head.layout_version = kLayoutVersion + 1;  // as if the next build had another one
  }
  const Frames* old = reader_.memory();
  const OwnedChannel<Frames> successor(bus_.name(), ChannelNames::kState);
  EXPECT_EQ(old->head.retired.load(), 1u);
  ASSERT_TRUE(reader_.poll());
  EXPECT_NE(reader_.memory(), old);
  publish(successor, 6);
  ASSERT_EQ(FrameReader<TestFrame>(reader_.memory()).newest(found_), Lookup::kFrame);
  EXPECT_EQ(found_.head.cycle, 6u);
  ASSERT_EQ(FrameReader<TestFrame>(old).newest(found_), Lookup::kFrame);
  EXPECT_EQ(found_.head.cycle, 5u);
}

TEST_F(BusTest, AnUnlinkedChannelGoesOnWithItsOldReadersUntilASuccessorAppears) {
  const OwnedChannel<Frames> writer(bus_.name(), ChannelNames::kState);
  ASSERT_TRUE(reader_.poll());
  const Frames* old = reader_.memory();
  unlink(file().c_str());
  EXPECT_FALSE(reader_.poll());
  publish(writer, 5);
  EXPECT_EQ(FrameReader<TestFrame>(reader_.memory()).newest(found_), Lookup::kFrame);
  const OwnedChannel<Frames> successor(bus_.name(), ChannelNames::kState);
  EXPECT_TRUE(reader_.poll());
  EXPECT_NE(reader_.memory(), old);
}

TEST_F(BusTest, RecreatesWhatIsLeftOfAnObject) {
  { OwnedChannel<Frames>(bus_.name(), ChannelNames::kState); }
  const std::string whole = content(file());
  for (const auto& [left, obstacle] : {std::pair{whole.substr(0, whole.size() - 1), "is truncated"},
                                       {"short", "is truncated"},
                                       {std::string(sizeof(Frames), '\0'), "has no content yet"},  // its maker died
                                       {std::string(sizeof(Frames), 'x'), "was not written by robot_control"},
                                       {"", ""}}) {
    plant(left);
    ForeignChannel<Frames> reader(bus_.name(), ChannelNames::kState);
    EXPECT_FALSE(reader.poll());
    EXPECT_THAT(reader.obstacle(), HasSubstr(obstacle));
    const OwnedChannel<Frames> writer(bus_.name(), ChannelNames::kState);
    EXPECT_TRUE(reader.poll()) << obstacle;
  }
}

TEST_F(BusTest, AnObjectTruncatedUnderItsWriterIsAnErrorForANewReader) {
  const OwnedChannel<Frames> writer(bus_.name(), ChannelNames::kState);
  ASSERT_EQ(truncate(file().c_str(), 100), 0);
  EXPECT_THAT(message_of<BusError>([&] { reader_.poll(); }), HasSubstr("its object is truncated"));
  EXPECT_THAT(write_error(), HasSubstr("its object is truncated"));
}

TEST_F(BusTest, AFileOfAnotherKindIsReplacedAndNeverWrittenTo) {
  const std::string content(sizeof(Frames), 'x');
  plant(content);
  const std::string kept = file() + ".kept";
  ASSERT_EQ(link(file().c_str(), kept.c_str()), 0);
  EXPECT_FALSE(reader_.poll());
  EXPECT_EQ(reader_.obstacle(), "was not written by robot_control");
  const OwnedChannel<Frames> writer(bus_.name(), ChannelNames::kState);
  EXPECT_TRUE(reader_.poll());
  std::ifstream old(kept, std::ios::binary);
  EXPECT_TRUE(std::string(std::istreambuf_iterator<char>(old), {}) == content);
}

// ---------------------------------------------------------------- robots

TEST_F(BusTest, ARobotIsNotKnownBeforeItIsAnnounced) {
  const OwnedChannel<Frames> sensors(bus_.name(), ChannelNames::kSensors);
  EXPECT_FALSE(same_robot(sensors.memory()->head, 9, "b.urdf"));
}

TEST_F(BusTest, TheSameRobotIsTheOneOfTheSameHash) {
  const OwnedChannel<Frames> sensors(bus_.name(), ChannelNames::kSensors);
  announce_robot(sensors.memory()->head, 9, "urdf/a.urdf");
  EXPECT_TRUE(same_robot(sensors.memory()->head, 9, "/robot_description"));
  EXPECT_EQ(announced_robot(sensors.memory()->head).source, "urdf/a.urdf");
}

TEST_F(BusTest, AnotherRobotIsRefusedNamingBothSources) {
  const OwnedChannel<Frames> sensors(bus_.name(), ChannelNames::kSensors);
  announce_robot(sensors.memory()->head, 9, "urdf/a.urdf");
  const std::string error = message_of<BusError>([&] { same_robot(sensors.memory()->head, 10, "urdf/b.urdf"); });
  EXPECT_THAT(error, HasSubstr("'urdf/a.urdf' (0000000000000009)"));
  EXPECT_THAT(error, HasSubstr("'urdf/b.urdf' (000000000000000a)"));
}

TEST_F(BusTest, ALongSourceIsCut) {
  const OwnedChannel<Frames> sensors(bus_.name(), ChannelNames::kSensors);
  announce_robot(sensors.memory()->head, 9, std::string(300, 'x'));
  EXPECT_EQ(announced_robot(sensors.memory()->head).source, std::string(255, 'x'));
}

}  // namespace robot_control::tests
