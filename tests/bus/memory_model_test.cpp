/// Tests the model itself on the litmus tests of the literature. It shows every outcome that the memory model of C++
/// allows, and none that it forbids.

#include "bus/model/memory_model.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

namespace robot_control::model {
namespace {

using Outcomes = std::set<std::vector<std::uint64_t>>;
constexpr auto kRelaxed = std::memory_order_relaxed;
constexpr auto kAcquire = std::memory_order_acquire;
constexpr auto kRelease = std::memory_order_release;

struct MemoryModelTest : testing::TestWithParam<Schedules> {
  MemoryModelTest() { model_.second_writes(y_.word()); }

  /// The values of `result_`.
  Outcomes outcomes(const MemoryModel::Body& first, const MemoryModel::Body& second) {
    Outcomes found;
    const Report report = model_.explore(
        [&] {
          result_.assign(4, 0);
          first();
        },
        second, [&] { found.insert(result_); }, GetParam());
    EXPECT_EQ(report.violation, "");
    return found;
  }

  MemoryModel model_;
  ModelAtomic<std::uint64_t> x_, flag_, y_;  // y alone is written by the second thread
  std::vector<std::uint64_t> result_ = std::vector<std::uint64_t>(4);
};

TEST_P(MemoryModelTest, AReleasedMessageIsSeenByItsAcquirer) {
  const Outcomes found = outcomes(
      [&] {
        x_.store(1, kRelaxed);
        flag_.store(1, kRelease);
      },
      [&] {
        result_[0] = flag_.load(kAcquire);
        result_[1] = x_.load(kRelaxed);
      });
  EXPECT_EQ(found, (Outcomes{{0, 0, 0, 0}, {0, 1, 0, 0}, {1, 1, 0, 0}}));
}

TEST_P(MemoryModelTest, ARelaxedMessageMayComeBeforeItsContent) {
  for (const auto& [store, load] : {std::pair{kRelaxed, kAcquire}, std::pair{kRelease, kRelaxed}}) {
    const Outcomes found = outcomes(
        [&, order = store] {
          x_.store(1, kRelaxed);
          flag_.store(1, order);
        },
        [&, order = load] {
          result_[0] = flag_.load(order);
          result_[1] = x_.load(kRelaxed);
        });
    EXPECT_EQ(found, (Outcomes{{0, 0, 0, 0}, {0, 1, 0, 0}, {1, 0, 0, 0}, {1, 1, 0, 0}}));
  }
}

TEST_P(MemoryModelTest, BothMayMissTheOthersStore) {
  const Outcomes found = outcomes(
      [&] {
        x_.store(1, kRelease);
        result_[0] = y_.load(kAcquire);
      },
      [&] {
        y_.store(1, kRelease);
        result_[1] = x_.load(kAcquire);
      });
  EXPECT_EQ(found, (Outcomes{{0, 0, 0, 0}, {0, 1, 0, 0}, {1, 0, 0, 0}, {1, 1, 0, 0}}));
}

TEST_P(MemoryModelTest, OneWordIsNeverSeenToGoBack) {
  const Outcomes found = outcomes(
      [&] {
        x_.store(1, kRelaxed);
        x_.store(2, kRelaxed);
      },
      [&] {
        for (std::size_t i = 0; i < 2; ++i) result_[i] = x_.load(kRelaxed);
      });
  EXPECT_EQ(found, (Outcomes{{0, 0, 0, 0}, {0, 1, 0, 0}, {0, 2, 0, 0}, {1, 1, 0, 0}, {1, 2, 0, 0}, {2, 2, 0, 0}}));
}

TEST_P(MemoryModelTest, AnAddContinuesTheReleaseThatItReads) {
  const Outcomes found = outcomes(
      [&] {
        x_.store(1, kRelaxed);
        flag_.store(1, kRelease);
        flag_.fetch_add(1, kRelaxed);
      },
      [&] {
        result_[0] = flag_.load(kAcquire);
        result_[1] = x_.load(kRelaxed);
      });
  EXPECT_EQ(found, (Outcomes{{0, 0, 0, 0}, {0, 1, 0, 0}, {1, 1, 0, 0}, {2, 1, 0, 0}}));
}

TEST_P(MemoryModelTest, AnAnswerComesAfterItsQuestion) {
  const Outcomes found = outcomes(
      [&] {
        x_.store(1, kRelaxed);
        result_[0] = y_.load(kAcquire);
        result_[1] = y_.load(kAcquire);
      },
      [&] {
        y_.store(1, kRelease);
        result_[2] = x_.load(kRelaxed);
        y_.store(2 + result_[2], kRelease);
      });
  Outcomes expected;
  for (const std::uint64_t seen : {0, 1}) {
    for (const auto& [first, second] : {std::pair{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}}) {
      const auto value = [&](int store) { return static_cast<std::uint64_t>(store == 2 ? 2 + seen : store); };
      expected.insert({value(first), value(second), seen, 0});
    }
  }
  EXPECT_EQ(found, expected);
}

TEST_P(MemoryModelTest, AProcessMayDieBeforeAnyOfItsStores) {
  const Outcomes found = outcomes(
      [&] {
        model_.mortal();
        x_.store(1, kRelease);
        flag_.store(1, kRelease);
        model_.revive();
        flag_.store(2, kRelease);
      },
      [&] {
        result_[0] = flag_.load(kAcquire);
        result_[1] = x_.load(kAcquire);
      });
  EXPECT_EQ(found, (Outcomes{{0, 0, 0, 0}, {0, 1, 0, 0}, {1, 1, 0, 0}, {2, 0, 0, 0}, {2, 1, 0, 0}}));
}

TEST_P(MemoryModelTest, AViolationEndsTheExploration) {
  const Report report = model_.explore([&] { x_.store(1, kRelaxed); },
                                       [&] {
                                         if (x_.load(kRelaxed) == 0) model_.fail("old");
                                       },
                                       {}, GetParam());
  EXPECT_EQ(report.violation, "old");
}

INSTANTIATE_TEST_SUITE_P(Schedules, MemoryModelTest, testing::Values(Schedules::kDistinct, Schedules::kAll),
                         [](const auto& schedules) {
                           return schedules.param == Schedules::kAll ? std::string("All") : std::string("Distinct");
                         });

}  // namespace
}  // namespace robot_control::model
