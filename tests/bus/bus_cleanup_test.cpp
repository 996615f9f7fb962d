#include "bus/bus_cleanup.h"

#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <filesystem>

#include "bus/bus.h"
#include "signals/command_frame.h"
#include "signals/permit.h"
#include "support/bus/scoped_bus.h"
#include "support/bus/test_frame.h"
#include "support/matchers.h"
#include "support/processes/child_process.h"

namespace robot_control::tests {

using ::testing::Contains;
using Frames = LatestFrames<TestFrame>;
using Permits = LatestFrames<Permit>;

std::string object_file(const std::string& bus, const std::string& channel) {
  return "/dev/shm" + bus_object_name(bus, channel);
}

bool is_there(const std::string& bus, const std::string& channel) {
  return std::filesystem::exists(object_file(bus, channel));
}

void publish_permit(const std::string& bus, std::uint64_t causes) {
  const OwnedChannel<Permits> channel(bus, ChannelNames::kPermit);
  Permit permit;
  permit.head.run = 7;
  permit.head.cycle = 3;
  permit.causes = causes;
  FrameWriter<Permit>(channel.memory()).publish(permit);
}

void publish_command(const std::string& bus, std::uint64_t zero_requested) {
  const OwnedChannel<LatestFrames<CommandFrame>> channel(bus, ChannelNames::kCommand);
  CommandFrame command;
  command.head.run = 7;
  command.head.cycle = 3;
  command.requests_received = 2;
  command.zero_requested = zero_requested;
  FrameWriter<CommandFrame>(channel.memory()).publish(command);
}

/// Leaves the bus as its nodes do when they end.
void end_bus(const std::string& bus, std::uint64_t causes = 0) {
  for (const char* name : {ChannelNames::kSensors, ChannelNames::kState, ChannelNames::kCommand}) {
    const OwnedChannel<Frames> channel(bus, name);
  }
  publish_permit(bus, causes);
}

struct BusCleanup : ::testing::Test {
  std::vector<std::string> removed() const { return remove_ended_buses(own_.name()); }

  ScopedBus own_;
  ScopedBus other_;
};

TEST_F(BusCleanup, RemovesABusWhoseProcessesHaveEnded) {
  end_bus(other_.name());
  EXPECT_THAT(removed(), Contains(other_.name()));
  for (const char* name :
       {ChannelNames::kSensors, ChannelNames::kState, ChannelNames::kCommand, ChannelNames::kPermit}) {
    EXPECT_FALSE(is_there(other_.name(), name)) << name;
  }
}

TEST_F(BusCleanup, LeavesItsOwn) {
  end_bus(own_.name());
  EXPECT_THAT(removed(), Not(Contains(own_.name())));
  EXPECT_TRUE(is_there(own_.name(), ChannelNames::kState));
}

TEST_F(BusCleanup, LeavesABusOfWhichAnyWriterLives) {
  for (const char* alive : {ChannelNames::kSensors, ChannelNames::kState, ChannelNames::kCommand, "trace_x"}) {
    const ScopedBus bus;
    end_bus(bus.name());
    const OwnedChannel<Frames> writer(bus.name(), alive);
    EXPECT_THAT(removed(), Not(Contains(bus.name()))) << alive;
    EXPECT_TRUE(is_there(bus.name(), ChannelNames::kSensors));
    EXPECT_TRUE(is_there(bus.name(), ChannelNames::kPermit));
  }
}

TEST_F(BusCleanup, LeavesABusWhoseLastPermitIsLatched) {
  end_bus(other_.name(), kCauseEmergencyStopService);
  EXPECT_THAT(removed(), Not(Contains(other_.name())));
  EXPECT_TRUE(is_there(other_.name(), ChannelNames::kPermit));
  EXPECT_TRUE(is_there(other_.name(), ChannelNames::kSensors));
  publish_permit(other_.name(), 0);
  EXPECT_THAT(removed(), Contains(other_.name())) << "reset by its own next run";
}

TEST_F(BusCleanup, LeavesTheCommandsIfMotionWasRequestedAtTheLastOne) {
  publish_permit(other_.name(), 0);
  publish_command(other_.name(), 0);
  EXPECT_THAT(removed(), Contains(other_.name()));
  EXPECT_TRUE(is_there(other_.name(), ChannelNames::kCommand));
  EXPECT_FALSE(is_there(other_.name(), ChannelNames::kPermit));
  EXPECT_THAT(removed(), Not(Contains(other_.name())));
  publish_command(other_.name(), 1);
  EXPECT_THAT(removed(), Contains(other_.name()));
  EXPECT_FALSE(is_there(other_.name(), ChannelNames::kCommand));
}

TEST_F(BusCleanup, TakesAPermitThatCannotBeReadForALatchedOne) {
  end_bus(other_.name());
  {
    const OwnedChannel<Permits> channel(other_.name(), ChannelNames::kPermit);
    Permit permit;
    permit.head.run = 7;
    permit.head.cycle = 4;
    seal(permit);
    permit.head.checksum = ~permit.head.checksum;
    FrameWriter<Permit>(channel.memory()).publish_sealed(permit);
  }
  EXPECT_THAT(removed(), Not(Contains(other_.name())));
  std::filesystem::resize_file(object_file(other_.name(), ChannelNames::kPermit), 100);
  EXPECT_THAT(removed(), Not(Contains(other_.name())));
}

TEST_F(BusCleanup, LeavesWhatIsNotThisUsersAlone) {
  end_bus(other_.name());
  ASSERT_EQ(chmod(object_file(other_.name(), ChannelNames::kState).c_str(), 0644), 0);
  EXPECT_THAT(removed(), Not(Contains(other_.name())));
  EXPECT_TRUE(is_there(other_.name(), ChannelNames::kSensors));
}

TEST_F(BusCleanup, ARemoverThatHoldsTheLocksForAMomentRefusesNoStart) {
  end_bus(other_.name());
  const ChildProcess remover([this] {
    auto object = SharedMemory::open(bus_object_name(other_.name(), ChannelNames::kState), Access::kReadWrite);
    if (!object || !object->lock()) return 1;
    sleep_ns(100'000'000);
    std::filesystem::remove(object_file(other_.name(), ChannelNames::kState));
    return 0;
  });
  sleep_ns(30'000'000);
  EXPECT_NO_THROW(OwnedChannel<Frames>(other_.name(), ChannelNames::kState));
}

/// Five start on a bus that ended, five on a new one; a third bus has one writer left, a fourth is latched.
TEST_F(BusCleanup, TenNodesThatStartAtOnceBesideAHalfDeadBusAllStartAndHarmNothing) {
  constexpr std::array<const char*, 5> kChannels{ChannelNames::kSensors, ChannelNames::kState, ChannelNames::kCommand,
                                                 ChannelNames::kTruth, "trace_x"};
  for (int round = 0; round < 20; ++round) {
    const ScopedBus ended, fresh, half_dead, latched, gone;
    end_bus(ended.name());
    end_bus(gone.name());
    end_bus(latched.name(), kCauseTilt);
    end_bus(half_dead.name());
    const OwnedChannel<Frames> writer(half_dead.name(), ChannelNames::kState);
    TestFrame frame = test_frame(7, 5);
    FrameWriter<TestFrame>(writer.memory()).publish(frame);

    std::array<int, 2> gate{};
    ASSERT_EQ(pipe(gate.data()), 0);
    std::vector<std::unique_ptr<ChildProcess>> nodes;
    for (const ScopedBus* bus : {&ended, &fresh}) {
      for (const char* name : kChannels) {
        nodes.push_back(std::make_unique<ChildProcess>([&, bus, name] {
          close(gate[1]);
          char end = 0;
          if (read(gate[0], &end, 1) < 0) return 2;  // until all may go
          const OwnedChannel<Frames> channel(bus->name(), name);
          for (int looks = 0; looks < 5; ++looks) remove_ended_buses(bus->name());
          return is_there(bus->name(), name) ? 0 : 3;
        }));
      }
    }
    close(gate[0]);
    close(gate[1]);
    for (const auto& node : nodes) EXPECT_EQ(node->wait(), 0) << "round " << round;

    FrameReader<TestFrame> reader(writer.memory());
    TestFrame kept;
    EXPECT_EQ(reader.newest(kept), Lookup::kFrame);
    for (const char* name :
         {ChannelNames::kSensors, ChannelNames::kState, ChannelNames::kCommand, ChannelNames::kPermit}) {
      EXPECT_TRUE(is_there(half_dead.name(), name)) << name;
      EXPECT_TRUE(is_there(latched.name(), name)) << name;
      EXPECT_FALSE(is_there(gone.name(), name)) << name;
    }
  }
}

}  // namespace robot_control::tests
