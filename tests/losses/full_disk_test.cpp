/// The disk under the log is full, at full speed: a file system of 512 kB in a mount namespace of telemetry's own,
/// which ends with it, where that is granted; else a limit on the file's size.

#include <sched.h>
#include <sys/mount.h>
#include <sys/resource.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "losses_fixture.h"

namespace robot_control {
namespace {

constexpr rlim_t kLimit = 512 * 1024;  // bytes, less than half a second of log

/// No other process sees it.
bool mount_small_disk(const std::string& folder) {
  return unshare(CLONE_NEWNS) == 0 && mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
         mount("tmpfs", folder.c_str(), "tmpfs", MS_NOSUID | MS_NODEV, "size=512k") == 0;
}

class AFullDisk : public Losses {
 protected:
  AFullDisk() : folder_(nodes().folder() / "log") {
    std::filesystem::create_directories(folder_);
    nodes().log_into(folder_);
  }

  void expect_told_and_counted(const std::string& why) {
    nodes().start(LoopNode::kTelemetry);
    expect_drives_on(1000);
    EXPECT_TRUE(robot_.await([&] { return nodes().desk().unwritten_rows.load() > 0; })) << "counted";
    const std::uint64_t unwritten = nodes().desk().unwritten_rows.load();
    expect_drives_on(kRingRows + 500);  // its rings would be full, were they not emptied on
    EXPECT_GT(nodes().desk().unwritten_rows.load(), unwritten + kRingRows);
    EXPECT_EQ(nodes().desk().lost_rows.load(), 0u) << "by the rings";
    expect_lives(LoopNode::kTelemetry);
    const std::string said = nodes().said(LoopNode::kTelemetry);
    EXPECT_NE(said.find(why), std::string::npos) << said;
    EXPECT_NE(said.find("make room"), std::string::npos) << said;
    EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << "once: " << said;
  }

  std::filesystem::path folder_;
};

TEST_F(AFullDisk, HarmsNothingAndItsLossesAreReportedAndCounted) {
  if (ChildProcess([this] { return mount_small_disk(folder_) ? 0 : 1; }).wait() != 0) {
    GTEST_SKIP() << "mounting is not granted";
  }
  nodes().prepare(LoopNode::kTelemetry, [this] {
    if (!mount_small_disk(folder_)) throw std::runtime_error("no small disk");
  });
  expect_told_and_counted("No space left on device");
}

TEST_F(AFullDisk, IsALimitOnTheFileJustSoAndTheLogEndsWithAWholeRow) {
  nodes().prepare(LoopNode::kTelemetry, [] {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{kLimit, kLimit};
    setrlimit(RLIMIT_FSIZE, &limit);
  });
  expect_told_and_counted("File too large");
  std::ifstream file(folder_ / "run.csv");
  std::string line, last;
  std::size_t columns = 0;
  while (std::getline(file, line)) {
    if (columns == 0) columns = static_cast<std::size_t>(std::count(line.begin(), line.end(), ','));
    last = line;
  }
  EXPECT_EQ(static_cast<std::size_t>(std::count(last.begin(), last.end(), ',')), columns);
}

}  // namespace
}  // namespace robot_control
