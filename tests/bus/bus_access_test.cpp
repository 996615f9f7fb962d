/// Checks who may open a channel's object, and what a node does with an object that others may open.

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "bus/bus.h"
#include "support/bus/scoped_bus.h"
#include "support/bus/test_frame.h"
#include "support/matchers.h"
#include "support/message_of.h"
#include "support/processes/anonymous_memory.h"
#include "support/processes/child_process.h"

namespace robot_control::tests {

using Frames = LatestFrames<TestFrame>;

constexpr uid_t kNobody = 65534;
constexpr unsigned kAlarm = 10;  // s; a process that waits that long on a pipe would wait endlessly

struct BusAccessTest : testing::Test {
  std::string file() const { return "/dev/shm" + bus_object_name(bus_.name(), ChannelNames::kState); }

  std::string write_error() const {
    return message_of<BusError>([&] { OwnedChannel<Frames>(bus_.name(), ChannelNames::kState); });
  }
  std::string read_error() const {
    return message_of<BusError>([&] { ForeignChannel<Frames>(bus_.name(), ChannelNames::kState).poll(); });
  }

  /// The error of both, which must be the same.
  std::string error() const {
    const std::string read = read_error();
    EXPECT_EQ(write_error(), read);
    return read;
  }

  mode_t mode() const {
    struct stat status {};
    EXPECT_EQ(stat(file().c_str(), &status), 0);
    return status.st_mode & 07777U;
  }

  void plant(mode_t mode) const {
    std::ofstream(file()).close();
    ASSERT_EQ(chmod(file().c_str(), mode), 0);
  }

  /// The result of `call` in a process of another user.
  template <class Call>
  static std::string as_nobody(Call call) {
    const AnonymousMemory<std::array<char, 1000>> answer;
    ChildProcess child([&] {
      if (setgid(kNobody) != 0 || setuid(kNobody) != 0) return 1;
      const std::string text = call();
      text.copy(answer->data(), answer->size() - 1);
      return 0;
    });
    EXPECT_EQ(child.wait(), 0);
    return answer->data();
  }

  ScopedBus bus_;
};

TEST_F(BusAccessTest, AnObjectIsOpenToItsUserAloneWhateverTheUmask) {
  for (const mode_t mask : {0000U, 0022U, 0777U}) {
    const mode_t before = umask(mask);
    const OwnedChannel<Frames> writer(bus_.name(), ChannelNames::kState);
    umask(before);
    EXPECT_EQ(mode(), 0600U) << mask;
    unlink(file().c_str());
  }
}

TEST_F(BusAccessTest, AnotherUserCannotOpenIt) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can act as another user";
  const OwnedChannel<Frames> writer(bus_.name(), ChannelNames::kState);
  const std::string theirs = file();
  for (const int access : {O_RDONLY, O_RDWR}) {
    EXPECT_EQ(as_nobody([&] { return std::string(std::strerror(open(theirs.c_str(), access) < 0 ? errno : 0)); }),
              std::strerror(EACCES));
  }
}

TEST_F(BusAccessTest, AReadersMappingCannotBeWrittenTo) {
  const OwnedChannel<Frames> writer(bus_.name(), ChannelNames::kState);
  ForeignChannel<Frames> reader(bus_.name(), ChannelNames::kState);
  ASSERT_TRUE(reader.poll());
  ChildProcess intruder([&] {
    signal(SIGSEGV, SIG_DFL);
    const_cast<Frames*>(reader.memory())->newest.store(1);
    return 0;
  });
  EXPECT_EQ(intruder.wait(), -1);
}

TEST_F(BusAccessTest, AnObjectOpenToOthersIsRefusedNamingItsModeAndLeftAsItIs) {
  for (const mode_t open_to_others : {0666U, 0660U, 0640U, 0604U, 0620U, 0601U}) {
    plant(open_to_others);
    char text[8];
    std::snprintf(text, sizeof text, "%04o", static_cast<unsigned>(open_to_others));
    EXPECT_THAT(error(), AllOf(HasSubstr("its mode is " + std::string(text)), HasSubstr("ls -l " + file()),
                               HasSubstr("remove it")));
    EXPECT_EQ(mode(), open_to_others);
  }
}

TEST_F(BusAccessTest, AnObjectOfAnotherUserIsRefusedNamingTheOwner) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can give an object away";
  plant(0600);
  ASSERT_EQ(chown(file().c_str(), kNobody, kNobody), 0);
  EXPECT_THAT(error(), AllOf(HasSubstr("channel 'state'"), HasSubstr("(65534), and this node runs as 'root' (0)"),
                             HasSubstr("remedy: see 'ls -l " + file())));
}

TEST_F(BusAccessTest, AnotherUsersObjectUnderOurNameIsRefusedOpenOrNot) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can act as another user";
  const std::string squatted = "/dev/shm/robot_control.65534." + bus_.name() + ".state";
  for (const mode_t mode : {0666U, 0600U}) {
    std::ofstream(squatted).close();
    ASSERT_EQ(chmod(squatted.c_str(), mode), 0);
    const auto belongs_to_root = AllOf(HasSubstr("belongs to 'root' (0)"), HasSubstr("runs as"), HasSubstr("65534"));
    EXPECT_THAT(as_nobody([&] { return read_error(); }), belongs_to_root) << mode;
    EXPECT_THAT(as_nobody([&] { return write_error(); }), belongs_to_root) << mode;
    unlink(squatted.c_str());
  }
}

TEST_F(BusAccessTest, ASymbolicLinkIsNotFollowed) {
  const std::string target = file() + ".target";
  std::ofstream(target) << "untouched";
  ASSERT_EQ(chmod(target.c_str(), 0600), 0);
  for (const std::string& to : {target, file() + ".nowhere"}) {
    ASSERT_EQ(symlink(to.c_str(), file().c_str()), 0);
    EXPECT_THAT(error(), AllOf(HasSubstr("a symbolic link has its name"), HasSubstr("remove it")));
    unlink(file().c_str());
  }
  std::string content;
  std::ifstream(target) >> content;
  EXPECT_EQ(content, "untouched");
  EXPECT_FALSE(std::filesystem::exists(file() + ".nowhere"));
}

TEST_F(BusAccessTest, ADirectoryIsRefused) {
  ASSERT_EQ(mkdir(file().c_str(), 0700), 0);
  EXPECT_THAT(error(), HasSubstr("a directory has its name"));
}

TEST_F(BusAccessTest, APipeIsRefusedAndBlocksNoProcess) {
  ASSERT_EQ(mkfifo(file().c_str(), 0600), 0);
  alarm(kAlarm);
  EXPECT_THAT(error(), HasSubstr("a pipe has its name"));
  alarm(0);
}

TEST_F(BusAccessTest, ALinkOfOneChannelsObjectToAnotherChannelsNameIsASecondInstance) {
  const OwnedChannel<Frames> command(bus_.name(), ChannelNames::kCommand);
  const std::string other = "/dev/shm" + bus_object_name(bus_.name(), ChannelNames::kCommand);
  ASSERT_EQ(link(other.c_str(), file().c_str()), 0);
  EXPECT_THAT(write_error(), HasSubstr("another process writes this channel"));
}

TEST_F(BusAccessTest, AChildProgramInheritsNoObject) {
  const OwnedChannel<Frames> writer(bus_.name(), ChannelNames::kState);
  int found = 0;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
    std::error_code ignored;
    if (std::filesystem::read_symlink(entry.path(), ignored) != file()) continue;
    ++found;
    EXPECT_NE(fcntl(std::stoi(entry.path().filename()), F_GETFD) & FD_CLOEXEC, 0);
  }
  EXPECT_EQ(found, 1);
}

/// While it lives no file can be opened.
class NoDescriptors {
 public:
  NoDescriptors() {
    getrlimit(RLIMIT_NOFILE, &before_);
    const rlimit none{.rlim_cur = 0, .rlim_max = before_.rlim_max};
    setrlimit(RLIMIT_NOFILE, &none);
  }
  NoDescriptors(const NoDescriptors&) = delete;
  NoDescriptors& operator=(const NoDescriptors&) = delete;
  ~NoDescriptors() { setrlimit(RLIMIT_NOFILE, &before_); }

 private:
  rlimit before_{};
};

TEST_F(BusAccessTest, AShortageOfDescriptorsPasses) {
  OwnedChannel<Frames> writer(bus_.name(), ChannelNames::kState);
  ForeignChannel<Frames> reader(bus_.name(), ChannelNames::kState);
  {
    const NoDescriptors shortage;
    EXPECT_FALSE(reader.poll());
    EXPECT_THAT(reader.obstacle(), HasSubstr("too many open files"));
  }
  EXPECT_TRUE(reader.poll());
  const Frames* const mapped = reader.memory();
  ASSERT_NE(mapped, nullptr);
  {
    const NoDescriptors shortage;
    EXPECT_FALSE(reader.poll());
    EXPECT_EQ(reader.memory(), mapped);
  }
  EXPECT_FALSE(reader.poll());
  EXPECT_EQ(reader.obstacle(), "");
}

TEST_F(BusAccessTest, AWriterThatStartsWithoutDescriptorsNamesThem) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the sanitizer needs descriptors for its look at the exception";
#endif
  const NoDescriptors shortage;
  EXPECT_THAT(write_error(), AllOf(HasSubstr("Too many open files"), HasSubstr("ulimit -n")));
}

}  // namespace robot_control::tests
