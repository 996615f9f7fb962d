/// A killed, damaged or cut black box gives its valid part, and reports the rest.

#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <random>

#include "black_box_fixture.h"
#include "support/matchers.h"

namespace robot_control::tests {

namespace fs = std::filesystem;

constexpr std::size_t kBag = BlackBox::kBagBytes;

struct ADamagedBlackBox : ABlackBox {
  ADamagedBlackBox() {
    BlackBox box(path("ring"), kBytes, header());
    drive_on(box, 6000);
    all = cycles_of_saved();
    std::string bytes;
    while (fs::exists(bag(bags + 1)) && begins(bag(bags + 1))) ++bags;
  }

  static bool begins(const std::string& file) { return std::ifstream(file, std::ios::binary).get() == '#'; }
  std::string bag(std::size_t number) const { return path("ring/" + std::to_string(number) + ".bag"); }

  std::vector<std::uint64_t> cycles_of_saved() {
    saved = save();
    std::vector<std::uint64_t> cycles = cycles_of(path("saved/run.bag"));
    fs::remove_all(path("saved"));
    return cycles;
  }
  void overwrite(std::size_t number, std::size_t offset, const std::string& bytes) const {
    std::fstream file(bag(number), std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(static_cast<std::streamoff>(offset));
    file << bytes;
  }

  std::size_t bags = 0;  ///< number of the newest one
  SavedBlackBox saved;
  std::vector<std::uint64_t> all;
};

TEST_F(ADamagedBlackBox, IsWholeBefore) {
  EXPECT_EQ(saved.missing, "");
  EXPECT_EQ(all.size(), 6000u);
  EXPECT_GE(bags, 2u);
}

/// A kill leaves a part of the last write; zeros follow.
TEST_F(ADamagedBlackBox, HoldsEveryWholeChunkWhereItsWriterWasKilledAtAnyByte) {
  std::mt19937_64 random(7);
  std::string content(kBag, '\0');
  std::ifstream(bag(bags), std::ios::binary).read(content.data(), kBag);
  const std::size_t end = content.find_last_not_of('\0') + 1;
  for (int trial = 0; trial < 30; ++trial) {
    const std::size_t at = trial < 10 ? random() % 20'000 : trial < 20 ? end - random() % 3000 : random() % end;
    SCOPED_TRACE(at);
    overwrite(bags, 0, content.substr(0, at) + std::string(kBag - at, '\0'));
    const std::vector<std::uint64_t> left = cycles_of_saved();
    EXPECT_EQ(left.size(), left.back() + 1) << "no gap";
    EXPECT_EQ(saved.missing, "");
    if (end - at < 3000) {
      EXPECT_GE(left.size(), all.size() - 4);
    }
  }
}

TEST_F(ADamagedBlackBox, LosesTheChunkThatIsDamagedAndNoOther) {
  std::string content(kBag, '\0');
  std::ifstream(bag(1), std::ios::binary).read(content.data(), kBag);
  const std::size_t chunk = content.find("compression=lz4", 500'000);  // an index that is damaged loses nothing
  overwrite(1, chunk + 100, "damaged, damaged, damaged, damaged, damaged, damaged");
  EXPECT_THAT(save().missing, HasSubstr("records are missing at 1 place of the others"));
  std::size_t rows = 0;
  std::vector<std::uint64_t> lost;
  TraceReader reader(path("saved/run.bag"));
  reader.read({.row = [&](const TraceRow& row, std::int64_t) {
    ++rows;
    lost.push_back(row.lost);
  }});
  EXPECT_EQ(lost.front(), 0u);
  EXPECT_EQ(lost.back(), all.size() - rows);
  EXPECT_EQ(lost.back(), 1u) << "each chunk is of a cycle here";
  EXPECT_THAT(reader.header().missing, HasSubstr("rows, in the cycles "));
}

TEST_F(ADamagedBlackBox, IsReadUpToWhereABagIsCutOff) {
  fs::resize_file(bag(1), kBag / 2);
  const std::vector<std::uint64_t> left = cycles_of_saved();
  EXPECT_EQ(left.front(), 0u);
  EXPECT_EQ(left.back(), 5999u);
  EXPECT_LT(left.size(), all.size());
  EXPECT_THAT(saved.missing, HasSubstr("bags that are cut off: 1 of 17; records are missing at 1 place"));
}

TEST_F(ADamagedBlackBox, IsReadAroundABagOfWhichNothingIsLeft) {
  overwrite(1, 0, std::string(kBag, 'x'));
  const std::vector<std::uint64_t> left = cycles_of_saved();
  EXPECT_EQ(left.front(), 0u);
  EXPECT_EQ(left.back(), 5999u);
  EXPECT_LT(left.size(), all.size());
  const auto gap = std::ranges::adjacent_find(left, [](auto one, auto next) { return next != one + 1; });
  ASSERT_NE(gap, left.end());
  EXPECT_THAT(saved.missing, HasSubstr("bags that cannot be read: 1 of 17"));
  EXPECT_THAT(saved.missing, HasSubstr("in the cycles " + std::to_string(*gap + 1) + " to "));
  fs::remove(bag(1));
  EXPECT_EQ(cycles_of_saved(), left);
  EXPECT_THAT(saved.missing, HasSubstr("bags that are not there: 1 of 17"));
}

TEST_F(ADamagedBlackBox, IsRefusedByWhatIsMissingWhereNothingIsLeft) {
  for (std::size_t i = 0; i <= bags; ++i) overwrite(i, 0, std::string(kBag, 'x'));
  EXPECT_THAT([&] { save(); }, ThrowsMessage<LogError>(HasSubstr("no record that is whole: the black box is damaged")));
}

TEST_F(ADamagedBlackBox, LeavesNoBagWhereItsBagCannotBeWritten) {
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit full{.rlim_cur = 300'000, .rlim_max = before.rlim_max};
  std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &full);
  EXPECT_THAT([&] { save(); }, ThrowsMessage<LogError>(HasSubstr("remove files")));
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_FALSE(fs::exists(path("saved")));
  folder.write("saved", "a file, no folder");
  EXPECT_THROW(save(), LogError);
  fs::remove(path("saved"));
  fs::create_directories(path("saved/run.bag"));
  EXPECT_THROW(save(), LogError);
  EXPECT_TRUE(fs::is_empty(path("saved/run.bag")));
  EXPECT_EQ(std::distance(fs::directory_iterator(path("saved")), {}), 1);
}

TEST_F(ADamagedBlackBox, GivesWhatIsSoundAndCountsEveryGapWhateverIsDamaged) {
  fs::copy(path("ring"), path("sound"));
  for (std::uint64_t seed = 0; seed < 15; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    const auto below = [&](std::uint64_t end) { return random() % end; };
    fs::copy(path("sound"), path("ring"), fs::copy_options::overwrite_existing);
    for (std::uint64_t i = 1 + below(5); i > 0; --i) {
      const std::string damage(1 + below(below(2) == 0 ? 9 : 9000), static_cast<char>(below(256)));
      overwrite(below(bags), 50'000 + below(kBag - 60'000), damage);
    }
    if (seed % 3 == 2) fs::resize_file(bag(below(bags)), 50'000 + below(kBag - 60'000));
    save();
    std::uint64_t rows = 0, next = 0, lost = 0;
    TraceReader(path("saved/run.bag")).read({.row = [&](const TraceRow& row, std::int64_t) {
      EXPECT_GE(row.cycle, next);
      lost += row.cycle - next;
      next = row.cycle + 1;
      ++rows;
      EXPECT_EQ(row.lost, lost) << row.cycle;
    }});
    EXPECT_EQ(rows + lost, all.size());
    fs::remove_all(path("saved"));
  }
}

}  // namespace robot_control::tests
