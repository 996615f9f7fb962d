/// The disk under the log is full, at full speed. If it is granted, that is a file system of 512 kB in a mount
/// namespace of telemetry's own, which ends with it. Otherwise a limit on the file's size replaces it.

#include <fcntl.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/resource.h>

#include <filesystem>

#include "log/trace_reader.h"
#include "losses_fixture.h"

namespace robot_control::tests {

constexpr rlim_t kLimit = 768 * 1024;  // bytes: room for one chunk of a second, not for two

/// The mount is invisible to every other process.
bool mount_small_disk(const std::string& folder) {
  return unshare(CLONE_NEWNS) == 0 && mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
         mount("tmpfs", folder.c_str(), "tmpfs", MS_NOSUID | MS_NODEV, "size=512k") == 0;
}

struct AFullDisk : Losses {
  AFullDisk() : folder_(nodes().folder() / "log") {
    std::filesystem::create_directories(folder_);
    nodes().log_into(folder_);
  }

  void expect_reported_and_counted(const std::string& why) {
    nodes().start(LoopNode::kTelemetry);
    expect_drives_on(1000);
    EXPECT_TRUE(robot_.await([&] { return nodes().controls().unwritten_rows.load() > 0; })) << "counted";
    const std::uint64_t unwritten = nodes().controls().unwritten_rows.load();
    // Its rings would be full, were they not emptied on. Rows are counted by whole chunks, of a second each.
    expect_drives_on(kRingRows + 1500);
    EXPECT_GT(nodes().controls().unwritten_rows.load(), unwritten + kRingRows);
    EXPECT_EQ(nodes().controls().lost_rows.load(), 0u) << "by the rings";
    expect_lives(LoopNode::kTelemetry);
    const std::string said = nodes().said(LoopNode::kTelemetry);
    EXPECT_NE(said.find(why), std::string::npos) << said;
    EXPECT_NE(said.find("remove files"), std::string::npos) << said;
    EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << "once: " << said;
  }

  std::filesystem::path folder_;
};

using NightlyFullDisk = AFullDisk;

TEST_F(NightlyFullDisk, HarmsNothingAndItsLossesAreReportedAndCounted) {
  if (ChildProcess([this] { return mount_small_disk(folder_) ? 0 : 1; }).wait() != 0) {
    GTEST_SKIP() << "mounting is not granted";
  }
  nodes().prepare(LoopNode::kTelemetry, [this] {
    if (!mount_small_disk(folder_)) throw std::runtime_error("no small disk");
  });
  expect_reported_and_counted("No space left on device");
}

TEST_F(AFullDisk, HarmsNothingAsALimitOnTheFileIsReportedAndTheLogIsReadToItsLastWholeChunk) {
  nodes().prepare(LoopNode::kTelemetry, [] {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{kLimit, kLimit};
    setrlimit(RLIMIT_FSIZE, &limit);
  });
  expect_reported_and_counted("File too large");
  std::size_t rows = 0;
  TraceReader(folder_ / "run.bag").read({.row = [&](const TraceRow&, std::int64_t) { ++rows; }});
  EXPECT_GT(rows, 500u);
}

TEST_F(NightlyFullDisk, IsReportedAndCountedAsAFolderThatIsRemoved) {
  nodes().start(LoopNode::kTelemetry);
  expect_drives_on(1500);
  std::filesystem::remove_all(folder_);
  EXPECT_TRUE(robot_.await([&] { return nodes().controls().unwritten_rows.load() > 0; })) << "counted";
  expect_drives_on(kRingRows + 500);
  EXPECT_EQ(nodes().controls().lost_rows.load(), 0u) << "by the rings";
  expect_lives(LoopNode::kTelemetry);
  EXPECT_NE(nodes().said(LoopNode::kTelemetry).find("was removed while it was written"), std::string::npos);
}

/// A file system cannot be made read-only while a log on it is open. But a read-only one may be mounted over the
/// folder: no other process can then read what is written on.
TEST_F(NightlyFullDisk, IsReportedAndCountedAsAReadOnlyOneAndTheLogsGoOnAfterwards) {
  if (ChildProcess([this] { return mount_small_disk(folder_) ? 0 : 1; }).wait() != 0) {
    GTEST_SKIP() << "mounting is not granted";
  }
  nodes().prepare(LoopNode::kTelemetry, [] {
    if (unshare(CLONE_NEWNS) != 0 || mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0) {
      throw std::runtime_error("no mount namespace");
    }
  });
  nodes().start(LoopNode::kTelemetry);
  expect_drives_on(1500);
  const std::string space = "/proc/" + std::to_string(nodes().process(LoopNode::kTelemetry).id()) + "/ns/mnt";
  const auto in_its_space = [&](auto act) {
    return ChildProcess([&] {
             const int name_space = open(space.c_str(), O_RDONLY | O_CLOEXEC);
             return setns(name_space, CLONE_NEWNS) == 0 && act() == 0 ? 0 : 1;
           })
        .wait();
  };
  ASSERT_EQ(in_its_space([&] { return mount("tmpfs", folder_.c_str(), "tmpfs", MS_RDONLY, nullptr); }), 0);
  EXPECT_TRUE(robot_.await([&] { return nodes().controls().unwritten_rows.load() > 0; })) << "counted";
  expect_drives_on(kRingRows + 500);
  EXPECT_EQ(nodes().controls().lost_rows.load(), 0u) << "by the rings";
  expect_lives(LoopNode::kTelemetry);
  ASSERT_EQ(in_its_space([&] { return umount2(folder_.c_str(), MNT_DETACH); }), 0);
  EXPECT_TRUE(robot_.await([&] { return std::filesystem::exists(folder_ / "run.1.bag"); }, 60));
}

}  // namespace robot_control::tests
