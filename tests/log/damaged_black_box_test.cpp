/// A damaged or cut black box gives its valid part, and reports the rest.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <random>

#include "black_box_fixture.h"
#include "log/black_box/black_box_reader.h"

namespace robot_control {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr std::size_t kSegment = BlackBoxFile::kSegmentBytes;

struct ADamagedBlackBox : ABlackBox {
  ADamagedBlackBox() {
    BlackBox box(path("ring"), kBytes, build_id(), header());
    drive_on(box, 6000);
    all = cycles_of_saved();
  }

  std::vector<std::uint64_t> cycles_of_saved() {
    saved = save();
    std::vector<std::uint64_t> cycles = cycles_of(path("saved/run.bag"));
    std::filesystem::remove_all(path("saved"));
    return cycles;
  }
  void overwrite(std::size_t offset, const std::string& bytes) const {
    std::fstream file(path("ring"), std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(static_cast<std::streamoff>(offset));
    file << bytes;
  }
  void cut(std::size_t bytes) const { std::filesystem::resize_file(path("ring"), bytes); }

  SavedBlackBox saved;
  std::vector<std::uint64_t> all;
};

constexpr std::size_t segment_at(std::size_t sequence) {
  return (1 + sequence) * kSegment;  // behind the head; in the first lap
}

TEST_F(ADamagedBlackBox, IsWholeBefore) {
  EXPECT_EQ(saved.missing, "");
  EXPECT_EQ(all.size(), 6000u);
}

TEST_F(ADamagedBlackBox, LosesTheRecordThatIsDamagedAndNoOther) {
  overwrite(segment_at(2) + 500'000, "damaged, damaged, damaged, damaged, damaged, damaged");
  EXPECT_THAT(save().missing, HasSubstr("records are missing at 1 place of the others"));
  std::size_t rows = 0;
  std::vector<std::uint64_t> lost;
  TraceReader reader(path("saved/run.bag"));
  reader.read({.row = [&](const TraceRow& row, std::int64_t) {
    ++rows;
    lost.push_back(row.lost);
  }});
  EXPECT_EQ(rows, all.size()) << "the rows of the other nodes";
  EXPECT_EQ(lost.front(), 0u);
  EXPECT_GE(lost.back(), 1u);
  EXPECT_LE(lost.back(), 2u) << "52 bytes are of two records at most";
  const LogHeader saved_header = reader.header();
  EXPECT_THAT(saved_header.missing, HasSubstr("rows of the nodes, in the cycles "));
}

TEST_F(ADamagedBlackBox, IsReadAroundASegmentOfWhichNothingIsLeft) {
  overwrite(segment_at(2), std::string(kSegment, 'x'));
  const std::vector<std::uint64_t> left = cycles_of_saved();
  EXPECT_EQ(left.front(), 0u);
  EXPECT_EQ(left.back(), 5999u);
  EXPECT_GT(left.size(), all.size() / 2);
  EXPECT_LT(left.size(), all.size());
  const auto gap = std::ranges::adjacent_find(left, [](auto one, auto next) { return next != one + 1; });
  ASSERT_NE(gap, left.end());
  EXPECT_THAT(saved.missing, HasSubstr("1 segment of 33, 1 MiB each, cannot be read"));
  // A node's row of the last cycle before the gap may be missing.
  const std::string cycles = "in the cycles ";
  EXPECT_THAT(saved.missing, AnyOf(HasSubstr(cycles + std::to_string(*gap) + " to "),
                                   HasSubstr(cycles + std::to_string(*gap + 1) + " to ")));
}

/// A sequence number that is too large would make every other segment one of earlier laps.
TEST_F(ADamagedBlackBox, LosesOneRecordWhereASequenceNumberIsDamaged) {
  const std::uint64_t sequence = 2 + 1000 * (kBytes / kSegment + 1);
  overwrite(segment_at(2) + sizeof sequence, {reinterpret_cast<const char*>(&sequence), sizeof sequence});
  EXPECT_EQ(cycles_of_saved(), all);
  EXPECT_THAT(saved.missing, HasSubstr("1 rows of the nodes"));
}

TEST_F(ADamagedBlackBox, IsReadUpToWhereItIsCutOff) {
  cut(segment_at(3) + kSegment / 2);
  const std::vector<std::uint64_t> left = cycles_of_saved();
  EXPECT_EQ(left.front(), 0u);
  EXPECT_GT(left.size(), all.size() / 4);
  EXPECT_LT(left.back(), all.back());
  EXPECT_EQ(left.size(), left.back() + 1) << "no gap";
  EXPECT_THAT(saved.missing, HasSubstr("it is cut off after " + std::to_string(segment_at(3) + kSegment / 2) + " of " +
                                       std::to_string(34 * kSegment) + " bytes"));
}

TEST_F(ADamagedBlackBox, OfWhichNothingIsLeftIsRefusedByWhatIsMissing) {
  cut(segment_at(0));
  EXPECT_THAT([&] { save(); }, ThrowsMessage<LogError>(HasSubstr("no record that is whole: the black box is damaged")));
  cut(100);
  EXPECT_THAT([&] { save(); }, ThrowsMessage<LogError>(HasSubstr("is cut off within its head: 100 of")));
}

TEST_F(ADamagedBlackBox, IsRefusedWhereItsHeadIsDamaged) {
  overwrite(1000, "x");
  EXPECT_THAT([&] { save(); }, ThrowsMessage<LogError>(HasSubstr("is damaged in its head")));
}

TEST_F(ADamagedBlackBox, LeavesNoBagWhereItsBagCannotBeWritten) {
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit full{.rlim_cur = 300'000, .rlim_max = before.rlim_max};
  std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &full);
  EXPECT_THAT([&] { save(); }, ThrowsMessage<LogError>(HasSubstr("make room")));
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_FALSE(std::filesystem::exists(path("saved")));
  folder.write("saved", "a file, no folder");
  EXPECT_THROW(save(), LogError);
  std::filesystem::remove(path("saved"));
  std::filesystem::create_directories(path("saved/run.bag"));
  EXPECT_THROW(save(), LogError);
  EXPECT_TRUE(std::filesystem::is_empty(path("saved/run.bag")));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(path("saved")), {}), 1);
}

/// Records are numbered: no undamaged one is lost, and every gap is noticed.
TEST(ARingOfRecords, GivesWhatIsSoundAndNoticesEveryGapWhateverIsDamaged) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    const auto below = [&](std::uint64_t end) { return random() % end; };
    const TemporaryFolder folder;
    const std::string path = folder.path() / "ring";
    const std::size_t segments = 2 + below(3);
    const auto written = static_cast<std::uint32_t>(1 + below(1500));
    {
      BlackBoxFile file(path, (segments - 1) * kSegment, "description");
      for (std::uint32_t i = 0; i < written; ++i) {
        const std::string data(1 + i * 7919 % 20'000, static_cast<char>(i));
        ASSERT_TRUE(file.append(i, i, data));
      }
    }
    const bool damaged = seed % 3 != 0;
    if (damaged) {
      std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
      for (std::uint64_t i = 1 + below(5); i > 0; --i) {
        file.seekp(static_cast<std::streamoff>(kSegment + below(segments * kSegment - 9000)));
        file << std::string(1 + below(below(2) == 0 ? 9 : 9000), static_cast<char>(below(256)));
      }
    }
    if (seed % 3 == 2) std::filesystem::resize_file(path, kSegment + below(segments * kSegment));
    const BlackBoxReader reader(path);
    bool gap = false, any = false;
    std::uint32_t last = 0;
    const auto look = [&](const BlackBoxRecord& record) {
      EXPECT_EQ(record.data, std::string(1 + record.kind * 7919 % 20'000, static_cast<char>(record.kind)));
      if (any) {
        EXPECT_GT(record.kind, last);
        if (record.kind != last + 1) {
          EXPECT_TRUE(gap) << "before " << record.kind;
        }
      }
      gap = false;
      any = true;
      last = record.kind;
    };
    const BlackBoxDamage damage = reader.read({.record = look, .gap = [&] { gap = true; }});
    if (damaged) continue;
    EXPECT_TRUE(damage.none());
    EXPECT_EQ(last, written - 1);
  }
}

}  // namespace
}  // namespace robot_control
