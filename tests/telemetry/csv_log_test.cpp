#include "telemetry/csv_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <fstream>

#include "support/temporary_folder.h"
#include "telemetry/traces.h"

namespace robot_control {
namespace {

/// A disk that accepts only so much of a file.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) {
    std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit full{.rlim_cur = bytes, .rlim_max = before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &full);
  }
  ~FullDisk() { setrlimit(RLIMIT_FSIZE, &before_); }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
};

class ACsvLog : public ::testing::Test {
 protected:
  /// True if the disk took the rows, or they wait for it.
  bool write(std::uint64_t rows) {
    bool taken = true;
    for (std::uint64_t i = 0; i < rows; ++i, ++given_) {
      JoinedRow row{.cycle = given_};
      row.driver = &driver_;
      try {
        log_.write(row);
      } catch (const LogError&) {
        taken = false;
      }
    }
    return taken;
  }
  std::uint64_t rows_in(const std::string& name) const {
    std::ifstream file(folder_.path() / name);
    const auto lines = std::count(std::istreambuf_iterator<char>(file), {}, '\n');
    return static_cast<std::uint64_t>(lines) - 1;
  }

  TemporaryFolder folder_;
  LogFolder logs_{folder_.path(), 0};
  CsvLog log_{logs_, log_columns(kJoints, false)};
  DriverTrace driver_ = driver_row(1, 0);
  std::uint64_t given_ = 0;
};

TEST_F(ACsvLog, GoesOnInAnotherFileOnceTheDiskTakesRowsAgainAndCountsThoseBetween) {
  {
    const FullDisk disk(100'000);
    EXPECT_FALSE(write(3000));
    EXPECT_TRUE(log_.broken());
  }
  std::int64_t now_ns = 1'000'000'000;
  log_.poll(now_ns);
  log_.poll(now_ns += CsvLog::kRetryNs - 1);
  EXPECT_TRUE(log_.broken()) << "not every time";
  log_.poll(now_ns += 1);
  EXPECT_FALSE(log_.broken());
  EXPECT_TRUE(write(500));
  log_.close();
  EXPECT_GT(rows_in("run.1.csv"), 100u);
  EXPECT_EQ(rows_in("run.csv"), 500u);
  EXPECT_EQ(log_.unwritten(), given_ - rows_in("run.1.csv") - 500);
}

TEST_F(ACsvLog, OnADiskThatTakesAllCountsNone) {
  EXPECT_TRUE(write(2000));
  log_.poll(1'000'000'000);
  log_.close();
  EXPECT_EQ(log_.unwritten(), 0u);
  EXPECT_EQ(rows_in("run.csv"), 2000u);
}

}  // namespace
}  // namespace robot_control
