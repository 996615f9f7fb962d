/// Objects are damaged from their heads on: a reader maps or refuses them with a reason, the next writer makes the
/// channel whole.

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

#include "bus/bus.h"
#include "support/bus/damage.h"
#include "support/bus/scoped_bus.h"
#include "support/bus/test_frame.h"

namespace robot_control::tests {

using Frames = LatestFrames<TestFrame>;
constexpr std::uint64_t kMutants = 3000;
constexpr std::uint64_t kLockedMutants = 20;  // a reader gives a living writer's object 0.1 s to settle

struct BusDamageTest : testing::Test {
  BusDamageTest() {
    const OwnedChannel<Frames> writer(bus_.name(), ChannelNames::kState);
    publish(writer, 5);
    std::ifstream file(this->file(), std::ios::binary);
    healthy_.assign(std::istreambuf_iterator<char>(file), {});
  }

  std::string file() const { return "/dev/shm" + bus_object_name(bus_.name(), ChannelNames::kState); }

  static void publish(const OwnedChannel<Frames>& channel, std::uint64_t cycle) {
    TestFrame frame = test_frame(7, cycle);
    FrameWriter<TestFrame>(channel.memory()).publish(frame);
  }

  /// Damages the whole object, its head, or its length.
  static void strike(Damage& damage, std::vector<char>& object) {
    const std::span<std::byte> bytes(reinterpret_cast<std::byte*>(object.data()), object.size());
    switch (damage.below(4)) {
      case 0:
        damage.strike(bytes);
        break;
      case 1:
        object.resize(damage.below(2 * object.size()));
        break;
      default:
        damage.strike(bytes.first(sizeof(ChannelHead)));
    }
  }

  void plant(const std::vector<char>& object) const {
    std::ofstream(file(), std::ios::binary | std::ios::trunc).write(object.data(), static_cast<long>(object.size()));
    ASSERT_EQ(chmod(file().c_str(), 0600), 0);
  }

  /// A mapped object can be read, and shows no frame but the published one.
  static void check_frames(const ForeignChannel<Frames>& reader) {
    if (reader.memory() == nullptr) return;
    TestFrame frame;
    const Lookup found = FrameReader<TestFrame>(reader.memory()).newest(frame);
    EXPECT_TRUE(found != Lookup::kFrame || frame.head.cycle == 5);
    EXPECT_LE(announced_robot(reader.memory()->head).source.size(), 256u);
  }

  ScopedBus bus_;
  std::vector<char> healthy_;
};

TEST_F(BusDamageTest, ADamagedLeftoverIsMappedOrNotAndTheNextWriterMakesItWhole) {
  for (std::uint64_t seed = 0; seed < kMutants && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    Damage damage(seed);
    std::vector<char> object = healthy_;
    strike(damage, object);
    plant(object);
    ForeignChannel<Frames> reader(bus_.name(), ChannelNames::kState);
    const bool mapped = reader.poll();
    EXPECT_EQ(mapped, reader.obstacle().empty());
    check_frames(reader);
    const OwnedChannel<Frames> writer(bus_.name(), ChannelNames::kState);
    publish(writer, 6);
    reader.poll();
    TestFrame frame;
    ASSERT_EQ(FrameReader<TestFrame>(reader.memory()).newest(frame), Lookup::kFrame);
    EXPECT_EQ(frame.head.cycle, 6u);
    unlink(file().c_str());
  }
}

TEST_F(BusDamageTest, WhatIsDamagedUnderALivingWriterIsMappedOrAnErrorThatNamesIt) {
  for (std::uint64_t seed = 0; seed < kLockedMutants && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    unlink(file().c_str());
    Damage damage(seed);
    const OwnedChannel<Frames> writer(bus_.name(), ChannelNames::kState);
    publish(writer, 5);
    ForeignChannel<Frames> before(bus_.name(), ChannelNames::kState);
    ASSERT_TRUE(before.poll());
    damage.strike({reinterpret_cast<std::byte*>(writer.memory()), sizeof(ChannelHead)});
    check_frames(before);
    ForeignChannel<Frames> after(bus_.name(), ChannelNames::kState);
    for (ForeignChannel<Frames>* const reader : {&before, &after}) {
      try {
        reader->poll();
      } catch (const BusError& error) {
        EXPECT_NE(std::string(error.what()).find(file()), std::string::npos);
      }
      check_frames(*reader);
    }
  }
}

}  // namespace robot_control::tests
