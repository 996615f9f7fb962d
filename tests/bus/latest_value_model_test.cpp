/// Runs the code of LatestValue itself, with two words, in every execution of a writer and a reader that the memory
/// model of C++ allows.

#include "bus/latest_value.h"
#include "bus/model/expectations.h"

namespace robot_control::model::tests {

/// Both words are the number of the store.
struct Pair {
  std::uint64_t first = 0;
  std::uint64_t second = 0;
};

struct LatestValueModelTest : testing::Test {
  LatestValueModelTest() {
    model_.name(0, "version");
    model_.name(1, "words");
    model_.name(2, "words");
  }

  void store_numbers(std::uint64_t last) {
    for (std::uint64_t number = 1; number <= last; ++number) latest_.store({number, number});
  }

  Report two_loads_during(std::uint64_t stores) {
    return model_.explore([this, stores] { store_numbers(stores); },
                          [this] {
                            Pair value;
                            latest_.load(value);
                            const std::uint64_t before = value.first;
                            latest_.load(value);
                            if (value.first != value.second) model_.fail("torn");
                            if (value.first < before) model_.fail("back");
                          },
                          [this, stores] {
                            Pair value;
                            if (!latest_.load(value) || value.first != stores) model_.fail("the last value is lost");
                          });
  }

  /// The results of one load during one store: the value, or that the writer interfered (99).
  std::set<std::uint64_t> found_by(Schedules schedules) {
    std::set<std::uint64_t> found;
    model_.explore([this] { store_numbers(1); },
                   [&] {
                     Pair value;
                     found.insert(latest_.load(value) ? value.first : 99);
                   },
                   {}, schedules);
    return found;
  }

  MemoryModel model_;
  LatestValue<Pair, ModelAtomic> latest_;
};

TEST_F(LatestValueModelTest, NoValueIsTornNoneIsOlderThanTheOneBeforeAndTheLastIsFound) {
  expect_no_violation(two_loads_during(2));
}

TEST_F(LatestValueModelTest, EveryOrderAndEveryCheckIsNeeded) {
  EXPECT_EQ(unnoticed(model_, "latest_value.h", {[this] { return two_loads_during(2); }}), std::set<std::string>{});
  EXPECT_GE(model_.mutants("latest_value.h").size(), 8u);
}

TEST_F(LatestValueModelTest, SchedulesThatAreLeftOutShowNothingNew) {
  EXPECT_EQ(found_by(Schedules::kDistinct), (std::set<std::uint64_t>{0, 1, 99}));
  EXPECT_EQ(found_by(Schedules::kAll), (std::set<std::uint64_t>{0, 1, 99}));
}

}  // namespace robot_control::model::tests
