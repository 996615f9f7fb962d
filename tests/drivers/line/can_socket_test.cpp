#include "drivers/line/can_socket.h"

#include <net/if.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>

#include "drivers/driver.h"
#include "drivers/line/can_bus.h"
#include "support/allocation_guard.h"
#include "support/matchers.h"
#include "support/quiet_refusal.h"
#include "support/temporary_folder.h"

namespace robot_control::tests {

can_frame message_of(std::uint64_t number) {
  return word_frame(0x123, number, 8);
}

std::string refusal(const std::string& address) {
  return quiet_refusal<DriverError>([&] { CanSocket::open(address); });
}

/// Three parties on one medium: a driver, a drive and a listener.
struct CanFolder : ::testing::Test {
  std::unique_ptr<CanBus> join() { return std::make_unique<CanBus>(CanSocket::open(address_)); }

  /// The numbers that the party received, at a time at which it searches for others.
  std::vector<std::uint64_t> heard(CanBus& party) {
    std::vector<std::uint64_t> numbers;
    now_.time_ns += kPartySearchNs;
    for (const ReceivedFrame& each : party.receive(now_).frames) numbers.push_back(data_word(each.frame));
    return numbers;
  }

  std::size_t send(CanBus& party, std::vector<std::uint64_t> numbers) {
    std::vector<can_frame> frames;
    for (const std::uint64_t number : numbers) frames.push_back(message_of(number));
    return party.send(frames);
  }

  TemporaryFolder folder_;
  std::string address_ = "unix:" + (folder_.path() / "bus").string();
  std::unique_ptr<CanBus> driver_ = join(), drive_ = join(), listener_ = join();
  CanTime now_;
};

TEST_F(CanFolder, EveryPartyReceivesWhatAnotherOneSendsAndNotItsOwn) {
  EXPECT_EQ(send(*driver_, {1, 2}), 2u);
  EXPECT_EQ(send(*drive_, {3}), 1u);
  EXPECT_THAT(heard(*driver_), ElementsAre(3));
  EXPECT_THAT(heard(*drive_), ElementsAre(1, 2));
  EXPECT_THAT(heard(*listener_), ElementsAre(1, 2, 3));
}

TEST_F(CanFolder, ALongBatchArrivesInItsOrder) {
  std::vector<std::uint64_t> numbers(100);
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = i;
  EXPECT_EQ(send(*driver_, numbers), 100u);
  EXPECT_EQ(heard(*drive_), numbers);
}

TEST_F(CanFolder, APartyThatJoinsLaterIsFound) {
  send(*driver_, {1});
  const auto late = join();
  send(*driver_, {2});
  EXPECT_THAT(heard(*late), IsEmpty()) << "the name was not there at the last search";
  heard(*driver_);
  send(*driver_, {3});
  EXPECT_THAT(heard(*late), ElementsAre(3));
}

TEST_F(CanFolder, APartyThatLeavesHarmsNoOther) {
  drive_.reset();
  EXPECT_EQ(send(*driver_, {1}), 1u);
  EXPECT_THAT(heard(*listener_), ElementsAre(1));
  EXPECT_EQ(driver_->counts().errors, 0u);
}

TEST_F(CanFolder, RefusesFramesWithoutAnotherPartyAsWithoutAcknowledgement) {
  drive_.reset();
  listener_.reset();
  EXPECT_EQ(send(*driver_, {1, 2}), 0u);
  EXPECT_EQ(driver_->counts().refused, 2u);
  EXPECT_EQ(driver_->counts().errors, 0u);
}

TEST_F(CanFolder, APartyThatDoesNotReceiveLosesFramesAndDelaysNoOther) {
  constexpr std::uint64_t kMany = 1000;  // more than the queue of any socket
  for (std::uint64_t i = 0; i < kMany; ++i) {
    EXPECT_EQ(send(*driver_, {i, i}), 2u);
    EXPECT_THAT(heard(*drive_), ElementsAre(i, i));
  }
  std::size_t kept = 0;
  for (ReceivedFrames batch{.frames = {}, .more = true}; batch.more; kept += batch.frames.size()) {
    batch = listener_->receive(now_);
  }
  EXPECT_GT(kept, 0u);
  EXPECT_LT(kept, 2 * kMany);
  EXPECT_EQ(driver_->counts().lost, 2 * kMany - kept);
}

TEST_F(CanFolder, AnEndedPartyFreesItsNameAndAKilledOneToo) {
  drive_.reset();
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "bus/1"));
  const pid_t child = fork();
  if (child == 0) {
    const CanSocket killed = CanSocket::open(address_);
    _exit(killed.own_party() == 1 ? 0 : 1);  // without the destructor
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_EQ(status, 0);
  ASSERT_TRUE(std::filesystem::exists(folder_.path() / "bus/1"));
  EXPECT_EQ(CanSocket::open(address_).own_party(), 1u);
}

TEST_F(CanFolder, TheSeventeenthPartyIsRefused) {
  std::vector<std::unique_ptr<CanBus>> parties;
  for (unsigned i = 3; i < kMaxParties; ++i) parties.push_back(join());
  EXPECT_THAT(refusal(address_), AllOf(HasSubstr("no free name"), HasSubstr("at most 16 programs share a folder")));
}

TEST_F(CanFolder, SendingAllocatesNothing) {
  const can_frame frames[] = {message_of(1), message_of(2)};
  AllocationGuard guard;
  EXPECT_EQ(driver_->send(frames), 2u);
  EXPECT_EQ(drive_->receive(now_).frames.size(), 2u);
  EXPECT_EQ(guard.count(), 0u);
}

TEST(CanSocket, AFolderOfOthersIsRefused) {
  const TemporaryFolder folder;
  chmod(folder.path().c_str(), 0770);
  EXPECT_THAT(refusal("unix:" + folder.path().string()),
              AllOf(HasSubstr("other users may write"), HasSubstr("chmod 700")));
}

TEST(CanSocket, AFolderOfAnotherUserIsRefused) {
  const TemporaryFolder folder;
  if (chown(folder.path().c_str(), 65534, 65534) != 0) GTEST_SKIP() << "only root gives a folder away";
  EXPECT_THAT(refusal("unix:" + folder.path().string()), HasSubstr("other users may write"));
}

TEST(CanSocket, ALinkToAFolderIsRefused) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "bus");
  std::filesystem::create_symlink("bus", folder.path() / "link");
  EXPECT_EQ(refusal("unix:" + (folder.path() / "bus").string()), "accepted");
  EXPECT_THAT(refusal("unix:" + (folder.path() / "link").string()), HasSubstr("set a folder of your own"));
}

TEST(CanSocket, AFolderThatCannotBeMadeIsRefused) {
  const TemporaryFolder folder;
  const std::string missing = (folder.path() / "absent/bus").string();
  EXPECT_THAT(refusal("unix:" + missing), AllOf(HasSubstr(missing), HasSubstr("No such file"), HasSubstr("parent")));
  folder.write("file", "");
  EXPECT_THAT(refusal("unix:" + (folder.path() / "file").string()), HasSubstr("Not a directory"));
}

TEST(CanSocket, APathThatIsTooLongIsRefused) {
  EXPECT_THAT(refusal("unix:/tmp/" + std::string(200, 'x')), AllOf(HasSubstr("205 bytes"), HasSubstr("at most 104")));
  EXPECT_FALSE(std::filesystem::exists("/tmp/" + std::string(200, 'x')));
}

TEST(CanSocket, AnInterfaceThatIsNotThereIsRefusedWithTheRemedy) {
  EXPECT_THAT(refusal("nocan7"), AllOf(HasSubstr("CAN bus nocan7: "), HasSubstr("; ")));
  EXPECT_THAT(refusal(""), HasSubstr("set can0, or unix:FOLDER"));
  EXPECT_THAT(refusal("name\x1b[2J_that_is_too_long"),
              AllOf(HasSubstr("\\x1b"), HasSubstr("not the name of an interface")));
}

TEST(CanSocket, SocketCanCarriesFramesBetweenTwoSockets) {
  if (if_nametoindex("vcan0") == 0) {
    GTEST_SKIP() << "no vcan0 here: modprobe vcan && ip link add vcan0 type vcan && ip link set vcan0 up";
  }
  const can_filter filter{.can_id = 0x123, .can_mask = CAN_EFF_FLAG | CAN_SFF_MASK};
  CanBus one(CanSocket::open("vcan0")), other(CanSocket::open("vcan0", {&filter, 1}));
  const can_frame frames[] = {message_of(1), word_frame(0x124, 2, 8), message_of(3)};
  EXPECT_EQ(one.send(frames), 3u);
  std::vector<std::uint64_t> heard;
  for (const ReceivedFrame& each : other.receive({}).frames) heard.push_back(data_word(each.frame));
  EXPECT_THAT(heard, ElementsAre(1, 3));
  EXPECT_TRUE(one.receive({}).frames.empty()) << "its own frames";
}

}  // namespace robot_control::tests
