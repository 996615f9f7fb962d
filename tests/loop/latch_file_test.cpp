#include "loop/latch_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "signals/permit.h"
#include "support/file_content.h"
#include "support/matchers.h"
#include "support/temporary_folder.h"

namespace robot_control::tests {

constexpr std::uint64_t kStops = kCauseEmergencyStopService | kCauseStall;

struct LatchFileTest : testing::Test {
  void keep(std::uint64_t causes, std::uint64_t first = kCauseStall) {
    LatchFile file(path);
    file.finish(causes, causes == 0 ? 0 : first);
    EXPECT_EQ(file.problem(), "");
  }
  LatchRecord found() const { return LatchFile(path).found(); }
  void write(const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

  TemporaryFolder folder;
  std::string path = folder.path() / "a/b/latch";
};

TEST_F(LatchFileTest, AnAbsentFileIsNoLatch) {
  EXPECT_EQ(found().causes, 0u);
  EXPECT_EQ(LatchFile("").found().causes, 0u);
}

TEST_F(LatchFileTest, KeepsCausesFirstCauseAndSince) {
  keep(kStops);
  EXPECT_EQ(found().causes, kStops);
  EXPECT_EQ(found().first_cause, std::uint64_t{kCauseStall});
  EXPECT_TRUE(found().since.starts_with("20")) << found().since;
}

TEST_F(LatchFileTest, SinceIsThatOfTheFirstCause) {
  std::filesystem::create_directories(std::filesystem::path(path).parent_path());
  write(latch_text({kCauseStall, kCauseStall, "2026-01-02T03:04:05Z"}));
  keep(kStops);
  EXPECT_EQ(found().since, "2026-01-02T03:04:05Z");
}

TEST_F(LatchFileTest, AReleaseIsKept) {
  keep(kStops);
  keep(0);
  EXPECT_EQ(found().causes, 0u);
  EXPECT_TRUE(std::filesystem::exists(path));
}

TEST_F(LatchFileTest, EveryChangeOfAByteIsALatch) {
  keep(kStops);
  const std::string text = content(path);
  for (std::size_t i = 0; i < text.size(); ++i) {
    std::string broken = text;
    broken[i] = static_cast<char>(broken[i] ^ 1);
    ASSERT_EQ(parse_latch(broken).causes, std::uint64_t{kCauseLatchUnreadable}) << "byte " << i;
    ASSERT_EQ(parse_latch(text.substr(0, i)).causes, std::uint64_t{kCauseLatchUnreadable}) << "first " << i;
  }
}

TEST_F(LatchFileTest, RandomBytesAreALatch) {
  std::mt19937 random(1);
  for (int i = 0; i < 1000; ++i) {
    std::string text(random() % 300, '\0');
    for (char& c : text) c = static_cast<char>(random());
    ASSERT_EQ(parse_latch(text).causes, std::uint64_t{kCauseLatchUnreadable}) << i;
  }
}

TEST_F(LatchFileTest, WhatIsNoRegularFileIsALatchAndHoldsNothingUp) {
  std::filesystem::create_directories(path);
  EXPECT_EQ(found().causes, std::uint64_t{kCauseLatchUnreadable});
  std::filesystem::remove(path);
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  EXPECT_EQ(found().causes, std::uint64_t{kCauseLatchUnreadable});
  EXPECT_EQ(LatchFile("/dev/zero").found().causes, std::uint64_t{kCauseLatchUnreadable});
}

TEST_F(LatchFileTest, WhatIsNoRegularFileIsNeverWrittenToNorReplaced) {
  std::filesystem::create_directories(std::filesystem::path(path).parent_path());
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  LatchFile file(path);
  file.finish(kStops, kCauseStall);
  EXPECT_NE(file.problem(), "");
  EXPECT_TRUE(std::filesystem::is_fifo(path));
}

TEST_F(LatchFileTest, SaysWhyItCannotWrite) {
  std::ofstream(folder.path() / "a") << "no folder";
  LatchFile file(path);
  file.finish(kStops, kCauseStall);
  EXPECT_NE(file.problem(), "");
}

TEST_F(LatchFileTest, FollowsASymbolicLink) {
  keep(0);
  const std::string link = folder.path() / "link";
  std::filesystem::create_symlink(path, link);
  LatchFile(link).finish(kStops, kCauseStall);
  EXPECT_TRUE(std::filesystem::is_symlink(link));
  EXPECT_EQ(found().causes, kStops);
}

TEST_F(LatchFileTest, ALinkToNothingIsALatchForItsDiskMayNotBeMounted) {
  path = folder.path() / "link";
  std::filesystem::create_symlink(folder.path() / "not_mounted/latch", path);
  EXPECT_EQ(found().causes, std::uint64_t{kCauseLatchUnreadable});
  std::filesystem::create_directories(folder.path() / "not_mounted");
  keep(0);
  EXPECT_EQ(found().causes, 0u) << "after a reset, once it is there";
}

TEST(LatchPath, IsAFileNamedAfterHostNamespaceAndRobotInAFolder) {
  MachineModel robot;
  robot.name = "../a dog";
  EXPECT_EQ(latch_path("/var/stop", "arm", "/robot2", robot), "/var/stop");
  EXPECT_THAT(latch_path("/var/stops/", "arm", "/", robot), StartsWith("/var/stops/latch.arm.___a_dog."));
  const std::string path = latch_path("/var/stops/", "arm", "/fleet/robot2", robot);
  EXPECT_THAT(path, StartsWith("/var/stops/latch.arm.fleet.robot2.___a_dog."));
  EXPECT_EQ(latch_path("", "arm", "/", robot), "");
  robot.joints.resize(1);
  robot.joints[0].name = "hip";
  EXPECT_NE(latch_path("/var/stops/", "arm", "/fleet/robot2", robot), path) << "another robot of that name";
}

TEST_F(LatchFileTest, OfAnOlderVersionBecomesThatOfTheFirstRobot) {
  path = folder.path() / "latch.arm.robot2";
  keep(kStops);
  MachineModel robot;
  robot.name = "dog";
  path = latch_path(folder.path(), "arm", "/robot2", robot);
  EXPECT_EQ(found().causes, kStops);
  keep(0);
  EXPECT_EQ(latch_path(folder.path(), "arm", "/robot2", robot), path);
  EXPECT_EQ(found().causes, 0u);
  robot.name = "cat";
  path = latch_path(folder.path(), "arm", "/robot2", robot);
  EXPECT_EQ(found().causes, 0u);
}

}  // namespace robot_control::tests
