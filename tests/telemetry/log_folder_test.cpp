#include "telemetry/log_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "support/temporary_folder.h"
#include "telemetry/csv_writer.h"
#include "telemetry/traces.h"

namespace robot_control {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class ALogFolder : public ::testing::Test {
 protected:
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
  keep("run.csv", 1);
  keep("run.2.csv", 1);
  keep("run.10.csv", 1);
  EXPECT_EQ(LogFolder(folder_.path(), 0).begin(), path("run.csv"));
  EXPECT_THAT(names(), ElementsAre("run.10.csv", "run.11.csv", "run.2.csv"));
}

TEST_F(ALogFolder, RemovesTheOldestRunsFirstAndNoMoreThanItMust) {
  keep("run.2.csv", 400);
  keep("run.9.csv", 300);
  keep("run.10.csv", 200);
  LogFolder folder(folder_.path(), 1000);
  EXPECT_TRUE(folder.make_room(100));
  EXPECT_THAT(folder.take_removed(), IsEmpty());
  EXPECT_TRUE(folder.make_room(101));
  EXPECT_THAT(folder.take_removed(), ElementsAre(path("run.2.csv")));
  EXPECT_TRUE(folder.make_room(500));
  EXPECT_THAT(names(), ElementsAre("run.10.csv", "run.9.csv"));
  EXPECT_TRUE(folder.make_room(1000));
  EXPECT_THAT(names(), IsEmpty());
  EXPECT_FALSE(folder.make_room(1001)) << "the running log fills it alone";
}

TEST_F(ALogFolder, WithoutAQuotaRemovesNothing) {
  keep("run.1.csv", 1000);
  EXPECT_TRUE(LogFolder(folder_.path(), 0).make_room(std::int64_t{1} << 40U));
  EXPECT_THAT(names(), ElementsAre("run.1.csv"));
}

TEST_F(ALogFolder, RemovesNothingThatIsNoLogOfItsOwn) {
  for (const char* name : {"run.1.csv.bak", "run..csv", "run.-1.csv", "run.1x.csv", "notes.csv", "run.bag"}) {
    keep(name, 1000);
  }
  std::filesystem::create_directory(path("run.3.csv"));
  std::filesystem::create_symlink("notes.csv", path("run.4.csv"));
  const std::vector<std::string> before = names();
  EXPECT_TRUE(LogFolder(folder_.path(), 10).make_room(10));
  EXPECT_EQ(names(), before);
}

TEST_F(ALogFolder, WritesToALinkAndRenamesNone) {
  keep("elsewhere.csv", 3);
  std::filesystem::create_symlink("elsewhere.csv", path("run.csv"));
  EXPECT_EQ(LogFolder(folder_.path(), 0).begin(), path("run.csv"));
  EXPECT_TRUE(std::filesystem::is_symlink(path("run.csv")));
}

TEST_F(ALogFolder, NeverHoldsMoreThanItsQuotaAndTheLogEndsWithAWholeRow) {
  constexpr std::int64_t kQuota = 1'000'000;
  keep("run.1.csv", 300'000);
  LogFolder folder(folder_.path(), kQuota);
  DriverTrace driver = driver_row(1, 0);
  JoinedRow row;
  row.driver = &driver;
  std::string problem;
  {
    CsvWriter csv(folder.begin(), log_columns(kJoints, false),
                  [&](std::int64_t bytes) { return folder.make_room(bytes); });
    try {
      for (int k = 0; k < 100'000; ++k) csv.write(row);
    } catch (const LogError& error) {
      problem = error.what();
    }
    csv.write(row);  // ignored
  }
  EXPECT_THAT(problem, HasSubstr("telemetry.quota is reached"));
  EXPECT_THAT(names(), ElementsAre("run.csv"));
  const auto bytes = static_cast<std::int64_t>(std::filesystem::file_size(path("run.csv")));
  EXPECT_LE(bytes, kQuota);
  EXPECT_GT(bytes, kQuota / 2);
  std::ifstream file(path("run.csv"));
  file.seekg(-1, std::ios::end);
  EXPECT_EQ(file.get(), '\n');
}

}  // namespace
}  // namespace robot_control
