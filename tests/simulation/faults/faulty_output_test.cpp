/// Checks an output whose healthy value in cycle k is k, under each kind of fault.

#include "simulation/faults/faulty_output.h"

#include <gtest/gtest.h>

#include <cmath>

namespace robot_control::tests {

constexpr std::uint64_t kSeed = 42;
constexpr std::uint64_t kOnset = 100;

/// No value: nothing was published.
using Outcome = std::optional<double>;

struct FaultyOutputTest : testing::Test {
  static void distort(FaultKind kind, double& value, FaultRandom& random) {
    value = kind == FaultKind::kWrong ? -value : random.within(1000);
  }

  Outcome step(FaultKind kind, std::uint64_t cycle) {
    value_ = static_cast<double>(cycle);
    return output_.step(kind, cycle, value_, distort) == Emission::kValue ? Outcome(value_) : Outcome();
  }

  /// Runs healthily up to kOnset, then for `cycles` with `kind`.
  std::vector<Outcome> run(FaultKind kind, std::uint64_t cycles) {
    for (std::uint64_t cycle = 0; cycle < kOnset; ++cycle) EXPECT_EQ(step(FaultKind::kOk, cycle), Outcome(cycle));
    std::vector<Outcome> outcomes;
    for (std::uint64_t cycle = kOnset; cycle < kOnset + cycles; ++cycle) outcomes.push_back(step(kind, cycle));
    return outcomes;
  }

  FaultyOutput<double> output_{kSeed};
  double value_ = 0;
};

TEST_F(FaultyOutputTest, IsTheHealthyOneAgainAfterOk) {
  for (const FaultKind kind : {FaultKind::kOff, FaultKind::kStuck, FaultKind::kDelayed, FaultKind::kSlow}) {
    output_.reset();
    run(kind, 25);
    EXPECT_EQ(step(FaultKind::kOk, 200), Outcome(200));
  }
}

TEST_F(FaultyOutputTest, IsNothingIfOff) {
  for (const Outcome& outcome : run(FaultKind::kOff, 50)) EXPECT_EQ(outcome, Outcome());
}

TEST_F(FaultyOutputTest, IsNothingOfAnUnknownKind) {
  for (const Outcome& outcome : run(static_cast<FaultKind>(99), 50)) EXPECT_EQ(outcome, Outcome());
}

TEST_F(FaultyOutputTest, IsTheFirstOneForEverIfStuck) {
  for (const Outcome& outcome : run(FaultKind::kStuck, 500)) EXPECT_EQ(outcome, Outcome(kOnset));
}

TEST_F(FaultyOutputTest, IsWhatTheComponentCallsWrongIfWrong) {
  const auto outcomes = run(FaultKind::kWrong, 50);
  for (std::size_t i = 0; i < outcomes.size(); ++i) EXPECT_EQ(outcomes[i], Outcome(-static_cast<double>(kOnset + i)));
}

TEST_F(FaultyOutputTest, IsRandomIfGarbage) {
  const auto outcomes = run(FaultKind::kGarbage, 1000);
  double sum = 0;
  for (const Outcome& outcome : outcomes) {
    ASSERT_TRUE(outcome);
    EXPECT_LT(std::abs(*outcome), 1000);
    sum += *outcome;
  }
  // The mean of n uniform numbers within ±b has the deviation b/√(3n) = 18; five of them.
  EXPECT_LT(std::abs(sum / 1000), 92);
}

TEST_F(FaultyOutputTest, IsNewEveryTenthCycleIfSlow) {
  const auto outcomes = run(FaultKind::kSlow, 35);
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    EXPECT_EQ(outcomes[i], i % kFaultCycles == 0 ? Outcome(kOnset + i) : Outcome()) << i;
  }
  EXPECT_EQ(value_, kOnset + 30.0) << "a reader that samples a register finds the last one";
}

TEST_F(FaultyOutputTest, IsNewAlsoWhenTheTenthCycleIsSkippedIfSlow) {
  run(FaultKind::kSlow, 5);
  EXPECT_EQ(step(FaultKind::kSlow, kOnset + 13), Outcome(kOnset + 13));
}

TEST_F(FaultyOutputTest, IsTenCyclesOldIfDelayed) {
  const auto outcomes = run(FaultKind::kDelayed, 40);
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const std::uint64_t expected = i < kFaultCycles ? kOnset : kOnset + i - kFaultCycles;
    EXPECT_EQ(outcomes[i], Outcome(expected)) << i;
  }
}

TEST_F(FaultyOutputTest, IsOffAndOnInSpellsOfTenCyclesIfIntermittent) {
  constexpr std::uint64_t kCycles = 100000;
  const auto outcomes = run(FaultKind::kIntermittent, kCycles);
  double off = 0, changes = 0;
  for (std::size_t i = 0; i < kCycles; ++i) {
    EXPECT_EQ(outcomes[i].value_or(static_cast<double>(kOnset + i)), static_cast<double>(kOnset + i));
    off += outcomes[i] ? 0 : 1;
    changes += i > 0 && outcomes[i].has_value() != outcomes[i - 1].has_value() ? 1 : 0;
  }
  // Changes are binomial: np = 10⁴, deviation √(np(1 − p)) = 95; five of them.
  EXPECT_NEAR(changes, 10000, 475);
  // The share of off cycles of a two-state chain has the variance (1/4)·(1 + r)/(1 − r)/n, r = 1 − 2p = 0.8:
  // deviation 0.0047; five of them.
  EXPECT_NEAR(off / kCycles, 0.5, 0.024);
}

TEST_F(FaultyOutputTest, IsTheSameForTheSameSeedAndCycle) {
  for (const FaultKind kind : {FaultKind::kGarbage, FaultKind::kIntermittent}) {
    output_.reset();
    const auto first = run(kind, 200);
    FaultyOutput<double> other{kSeed};
    std::vector<Outcome> second;
    for (std::uint64_t cycle = kOnset; cycle < kOnset + 200; ++cycle) {
      double value = static_cast<double>(cycle);
      second.push_back(other.step(kind, cycle, value, distort) == Emission::kValue ? Outcome(value) : Outcome());
    }
    EXPECT_EQ(first, second) << "whatever came before the fault";
  }
}

TEST_F(FaultyOutputTest, DiffersFromComponentToComponent) {
  const auto first = run(FaultKind::kIntermittent, 200);
  output_ = FaultyOutput<double>{kSeed + 1};
  EXPECT_NE(first, run(FaultKind::kIntermittent, 200));
}

}  // namespace robot_control::tests
