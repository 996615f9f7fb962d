#include "telemetry/log_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "support/temporary_folder.h"
#include "telemetry/csv_writer.h"
#include "telemetry/log_error.h"
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
  EXPECT_EQ(LogFolder(folder_.path(), 0).begin(LogKind::kCsv), path("run.csv"));
  EXPECT_THAT(names(), ElementsAre("run.10.csv", "run.11.csv", "run.2.csv"));
}

TEST_F(ALogFolder, IsOfOneWriterEvenBeforeItsLogHoldsAByte) {
  {
    LogFolder folder(folder_.path(), 0);
    const LogFile log(folder.begin(LogKind::kBag), {});
    LogFolder other(folder_.path(), 0);
    EXPECT_THAT([&] { other.begin(LogKind::kBag); },
                ::testing::ThrowsMessage<LogError>(HasSubstr("is used by another telemetry")));
    EXPECT_THAT([&] { other.begin(LogKind::kCsv); }, ::testing::Throws<LogError>()) << "whatever it writes";
    std::filesystem::remove_all(folder_.path());
    folder.begin(LogKind::kBag);
    EXPECT_THAT([&] { other.begin(LogKind::kBag); }, ::testing::Throws<LogError>()) << "one that was made again, too";
  }
  LogFolder(folder_.path(), 0).begin(LogKind::kBag);
}

TEST_F(ALogFolder, KeepsNoLogWithoutAByte) {
  keep("run.bag", 0);
  keep("run.1.bag", 5);
  EXPECT_EQ(LogFolder(folder_.path(), 0).begin(LogKind::kBag), path("run.bag"));
  EXPECT_THAT(names(), ElementsAre("run.1.bag", "run.bag"));
}

TEST_F(ALogFolder, RemovesTheOldestRunsFirstAndNoMoreThanItMust) {
  keep("run.2.csv", 400);
  keep("run.9.csv", 300);
  keep("run.10.csv", 200);
  LogFolder folder(folder_.path(), 1000);
  EXPECT_TRUE(folder.make_room(LogKind::kCsv, 100));
  EXPECT_THAT(folder.take_removed(), IsEmpty());
  EXPECT_TRUE(folder.make_room(LogKind::kCsv, 101));
  EXPECT_THAT(folder.take_removed(), ElementsAre(path("run.2.csv")));
  EXPECT_TRUE(folder.make_room(LogKind::kCsv, 500));
  EXPECT_THAT(names(), ElementsAre("run.10.csv", "run.9.csv"));
  EXPECT_TRUE(folder.make_room(LogKind::kCsv, 1000));
  EXPECT_THAT(names(), IsEmpty());
  EXPECT_FALSE(folder.make_room(LogKind::kCsv, 1001)) << "the running log fills it alone";
}

TEST_F(ALogFolder, CountsBothKindsOfLogAndNumbersThemTogether) {
  keep("run.3.csv", 400);
  keep("run.4.bag", 300);
  keep("run.bag", 200);
  LogFolder folder(folder_.path(), 1000);
  EXPECT_EQ(folder.begin(LogKind::kBag), path("run.bag"));
  EXPECT_THAT(names(), ElementsAre("run.3.csv", "run.4.bag", "run.5.bag"));
  EXPECT_TRUE(folder.make_room(LogKind::kBag, 60));
  EXPECT_TRUE(folder.make_room(LogKind::kCsv, 40));
  EXPECT_THAT(folder.take_removed(), IsEmpty());
  EXPECT_TRUE(folder.make_room(LogKind::kCsv, 41));
  EXPECT_THAT(folder.take_removed(), ElementsAre(path("run.3.csv")));
  EXPECT_FALSE(folder.make_room(LogKind::kBag, 960)) << "the running logs fill it together";
}

TEST_F(ALogFolder, LeavesHalfOfItsQuotaToABagBesideATable) {
  LogFolder folder(folder_.path(), 1000);
  EXPECT_TRUE(folder.make_room(LogKind::kBag, 10));
  EXPECT_TRUE(folder.make_room(LogKind::kCsv, 500));
  EXPECT_FALSE(folder.make_room(LogKind::kCsv, 501));
  EXPECT_TRUE(folder.make_room(LogKind::kBag, 400));
}

TEST_F(ALogFolder, WithoutAQuotaRemovesNothing) {
  keep("run.1.csv", 1000);
  EXPECT_TRUE(LogFolder(folder_.path(), 0).make_room(LogKind::kCsv, std::int64_t{1} << 40U));
  EXPECT_THAT(names(), ElementsAre("run.1.csv"));
}

TEST_F(ALogFolder, RemovesNothingThatIsNoLogOfItsOwn) {
  for (const char* name : {"run.1.csv.bak", "run..csv", "run.-1.csv", "run.1x.csv", "notes.csv", "run.x.bag"}) {
    keep(name, 1000);
  }
  std::filesystem::create_directory(path("run.3.csv"));
  std::filesystem::create_symlink("notes.csv", path("run.4.csv"));
  const std::vector<std::string> before = names();
  EXPECT_TRUE(LogFolder(folder_.path(), 10).make_room(LogKind::kCsv, 10));
  EXPECT_EQ(names(), before);
}

TEST_F(ALogFolder, WritesToALinkAndRenamesNone) {
  keep("elsewhere.csv", 3);
  std::filesystem::create_symlink("elsewhere.csv", path("run.csv"));
  EXPECT_EQ(LogFolder(folder_.path(), 0).begin(LogKind::kCsv), path("run.csv"));
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
    CsvWriter csv(folder.begin(LogKind::kCsv), log_columns(kJoints, false),
                  [&](std::int64_t bytes) { return folder.make_room(LogKind::kCsv, bytes); });
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
