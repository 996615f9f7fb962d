#include "log/log_folder.h"

#include <filesystem>

#include "log/bag_writer.h"
#include "log/log_error.h"
#include "support/matchers.h"
#include "support/temporary_folder.h"

namespace robot_control::tests {

struct ALogFolder : ::testing::Test {
  std::string path(const std::string& name) const { return folder_.path() / name; }
  void keep(const std::string& name, std::size_t bytes) const { folder_.write(name, std::string(bytes, 'x')); }
  std::vector<std::string> names() const {
    std::vector<std::string> found;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
      found.push_back(entry.path().filename());
    }
    std::ranges::sort(found);
    return found;
  }

  TemporaryFolder folder_;
};

TEST_F(ALogFolder, KeepsAnEarlierRunUnderTheNextNumber) {
  keep("run.bag", 1);
  keep("run.2.bag", 1);
  keep("run.10.bag", 1);
  EXPECT_EQ(LogFolder(folder_.path(), 0).begin(), path("run.bag"));
  EXPECT_THAT(names(), ElementsAre("run.10.bag", "run.11.bag", "run.2.bag"));
}

TEST_F(ALogFolder, IsOfOneWriterEvenBeforeItsLogHoldsAByte) {
  {
    LogFolder folder(folder_.path(), 0);
    const LogFile log(folder.begin(), {});
    LogFolder other(folder_.path(), 0);
    EXPECT_THAT([&] { other.begin(); }, ::testing::ThrowsMessage<LogError>(HasSubstr("is used by another telemetry")));
    std::filesystem::remove_all(folder_.path());
    folder.begin();
    EXPECT_THAT([&] { other.begin(); }, ::testing::Throws<LogError>()) << "one that was made again, too";
  }
  LogFolder(folder_.path(), 0).begin();
}

TEST_F(ALogFolder, KeepsNoLogWithoutAByte) {
  keep("run.bag", 0);
  keep("run.1.bag", 5);
  EXPECT_EQ(LogFolder(folder_.path(), 0).begin(), path("run.bag"));
  EXPECT_THAT(names(), ElementsAre("run.1.bag", "run.bag"));
}

TEST_F(ALogFolder, RemovesTheOldestRunsFirstAndNoMoreThanItMust) {
  keep("run.2.bag", 400);
  keep("run.9.bag", 300);
  keep("run.10.bag", 200);
  LogFolder folder(folder_.path(), 1000);
  EXPECT_TRUE(folder.make_room(100));
  EXPECT_THAT(folder.take_removed(), IsEmpty());
  EXPECT_TRUE(folder.make_room(101));
  EXPECT_THAT(folder.take_removed(), ElementsAre(path("run.2.bag")));
  EXPECT_TRUE(folder.make_room(500));
  EXPECT_THAT(names(), ElementsAre("run.10.bag", "run.9.bag"));
  EXPECT_TRUE(folder.make_room(1000));
  EXPECT_THAT(names(), IsEmpty());
  EXPECT_FALSE(folder.make_room(1001)) << "the running log fills it alone";
}

TEST_F(ALogFolder, RemovesNothingWithoutAQuota) {
  keep("run.1.bag", 1000);
  EXPECT_TRUE(LogFolder(folder_.path(), 0).make_room(std::int64_t{1} << 40U));
  EXPECT_THAT(names(), ElementsAre("run.1.bag"));
}

TEST_F(ALogFolder, RemovesNothingThatIsNoLogOfItsOwn) {
  for (const char* name :
       {"run.1.bag.bak", "run..bag", "run.-1.bag", "run.1x.bag", "notes.bag", "run.x.bag", "run.1.csv", "run.csv"}) {
    keep(name, 1000);
  }
  std::filesystem::create_directory(path("run.3.bag"));
  std::filesystem::create_symlink("notes.bag", path("run.4.bag"));
  const std::vector<std::string> before = names();
  EXPECT_TRUE(LogFolder(folder_.path(), 10).make_room(10));
  EXPECT_EQ(names(), before);
}

TEST_F(ALogFolder, WritesToALinkAndRenamesNone) {
  keep("elsewhere.bag", 3);
  std::filesystem::create_symlink("elsewhere.bag", path("run.bag"));
  EXPECT_EQ(LogFolder(folder_.path(), 0).begin(), path("run.bag"));
  EXPECT_TRUE(std::filesystem::is_symlink(path("run.bag")));
}

TEST_F(ALogFolder, NeverHoldsMoreThanItsQuotaAndTheLogEndsWithAWholePart) {
  constexpr std::int64_t kQuota = 1'000'000;
  keep("run.1.bag", 300'000);
  LogFolder folder(folder_.path(), kQuota);
  LogFile log(folder.begin(), [&](std::int64_t bytes) { return folder.make_room(bytes); });
  const std::string part(7'000, 'x');
  std::string problem;
  try {
    for (int k = 0; k < 1000; ++k) log.append(part);
  } catch (const LogError& error) {
    problem = error.what();
  }
  EXPECT_THAT(problem, HasSubstr("telemetry.quota is reached"));
  EXPECT_FALSE(log.open());
  EXPECT_THAT(names(), ElementsAre("run.bag"));
  EXPECT_EQ(std::filesystem::file_size(path("run.bag")), kQuota / 7'000 * 7'000);
}

}  // namespace robot_control::tests
