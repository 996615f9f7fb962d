/// The latch keeps the measurements of one cycle, the evidence of a stop, and the warnings of a second.

#include <gtest/gtest.h>

#include "safety/latch/evidence.h"
#include "safety/latch/supervisor.h"
#include "safety/latch/warnings.h"

namespace robot_control::tests {

constexpr double kTick = 0.01;  // s: a warning is held for 100 cycles

constexpr StopCause bit_of(std::size_t bit) {
  return static_cast<StopCause>(std::uint64_t{1} << bit);
}

ConditionMeasurement measured(double value) {
  return {.beyond = true, .value = value, .limit = 10, .joint = 2};
}

ActiveCauses active_with(StopCause active, Reaction reaction, double value = 11) {
  ActiveCauses causes;
  causes.add(active, reaction, measured(value));
  return causes;
}

TEST(ActiveCauses, KeepTheFirstMeasurementOfEachCause) {
  ActiveCauses causes;
  causes.add(bit_of(3), Reaction::kBrake, measured(11));
  causes.add(bit_of(3), Reaction::kBrake, measured(12));
  causes.add(bit_of(5), Reaction::kRamp, measured(13));
  ASSERT_EQ(causes.measurements().size(), 2u);
  EXPECT_EQ(causes.measurements()[0].cause, bit_of(3));
  EXPECT_EQ(causes.measurements()[0].value, 11);
  EXPECT_EQ(causes.measurements()[0].limit, 10);
  EXPECT_EQ(causes.measurements()[0].joint, 2u);
  EXPECT_EQ(causes.measurements()[1].cause, bit_of(5));
}

TEST(ActiveCauses, OnlyRampAndBrakeStop) {
  ActiveCauses causes;
  causes.add(bit_of(1), Reaction::kWarn);
  causes.add(bit_of(2), Reaction::kSlow);
  EXPECT_EQ(causes.stopping(), 0u);
  causes.add(bit_of(3), Reaction::kRamp);
  causes.add(bit_of(4), Reaction::kBrake);
  EXPECT_EQ(causes.stopping(), bit_of(3) | bit_of(4));
  EXPECT_EQ(causes.with(Reaction::kSlow), std::uint64_t{bit_of(2)});
  causes.clear();
  EXPECT_EQ(causes.stopping() | causes.with(Reaction::kWarn) | causes.with(Reaction::kSlow), 0u);
  EXPECT_TRUE(causes.measurements().empty());
}

TEST(ActiveCauses, HoldAllCausesThatThereAre) {
  ActiveCauses causes;
  for (std::size_t bit = 0; bit < kStopCauses; ++bit) causes.add(bit_of(bit), Reaction::kBrake);
  EXPECT_EQ(causes.measurements().size(), kStopCauses);
}

TEST(ActiveCauses, OfAConditionThatIsNotActiveNoneIsAdded) {
  ActiveCauses causes;
  ConditionWatch watch(bit_of(3), {.limit = 10, .persistence = 2 * kTick, .reaction = Reaction::kBrake}, kTick);
  causes.update(watch, measured(11), 1);
  causes.add(watch);
  EXPECT_EQ(causes.stopping(), 0u);
  causes.update(watch, measured(12), 1);
  EXPECT_EQ(causes.stopping(), std::uint64_t{bit_of(3)});
  EXPECT_EQ(causes.measurements()[0].value, 12);
}

struct EvidenceOf : testing::Test {
  std::array<CauseEvidence, kMaxEvidence> written() const {
    std::array<CauseEvidence, kMaxEvidence> out;
    out.fill({.cause = 1, .value = 99});
    evidence_.write(warnings_, out);
    return out;
  }
  std::vector<std::uint64_t> causes() const {
    std::vector<std::uint64_t> found;
    for (const CauseEvidence& row : written()) found.push_back(row.cause);
    while (!found.empty() && found.back() == 0) found.pop_back();
    return found;
  }
  using Causes = std::vector<std::uint64_t>;

  Evidence evidence_;
  Warnings warnings_{kTick};
};

TEST_F(EvidenceOf, CausesIsWrittenWithTheCycleOfItsLatchAndTheRestIsEmpty) {
  evidence_.latch(active_with(bit_of(3), Reaction::kBrake), 7);
  evidence_.latch(active_with(bit_of(3), Reaction::kBrake, 12), 8);
  EXPECT_EQ(written()[0].cycle, 7u);
  EXPECT_EQ(written()[0].value, 11);
  for (std::size_t i = 1; i < kMaxEvidence; ++i) {
    EXPECT_EQ(written()[i].cause, 0u);
    EXPECT_EQ(written()[i].value, 0);
  }
}

TEST_F(EvidenceOf, EachCauseIsWrittenInANewMonitor) {
  for (std::size_t bit = 0; bit < kStopCauses; ++bit) {
    Evidence evidence;
    evidence.latch(active_with(bit_of(bit), Reaction::kBrake), 7);
    std::array<CauseEvidence, kMaxEvidence> out;
    evidence.write(warnings_, out);
    EXPECT_EQ(out[0].cause, bit_of(bit));
  }
}

TEST_F(EvidenceOf, WarningsIsNotLatched) {
  evidence_.latch(active_with(bit_of(3), Reaction::kSlow), 7);
  EXPECT_EQ(causes(), Causes());
}

TEST_F(EvidenceOf, ManyCausesIsThatOfTheFirst) {
  ActiveCauses active;
  Causes first;
  for (std::size_t bit = 0; bit < kMaxEvidence + 2; ++bit) {
    active.add(bit_of(bit), Reaction::kBrake);
    if (bit < kMaxEvidence) first.push_back(bit_of(bit));
  }
  evidence_.latch(active, 7);
  EXPECT_EQ(causes(), first);
  warnings_.step(active_with(bit_of(20), Reaction::kWarn), 8, 1);
  EXPECT_EQ(causes(), first) << "no room for a warning";
}

TEST_F(EvidenceOf, WarningsFollowsThatOfCausesInTheOrderOfTheirBits) {
  ActiveCauses active = active_with(bit_of(9), Reaction::kWarn);
  active.add(bit_of(0), Reaction::kSlow);
  warnings_.step(active, 5, 1);
  evidence_.latch(active_with(bit_of(6), Reaction::kRamp), 7);
  EXPECT_EQ(causes(), (Causes{bit_of(6), bit_of(0), bit_of(9)}));
}

TEST_F(EvidenceOf, AnEarlierMonitorIsTakenOverForItsLatchedCauses) {
  evidence_.latch(active_with(bit_of(8), Reaction::kBrake), 3);
  Permit last;
  last.causes = bit_of(3) | bit_of(5);
  last.evidence[0] = {.cause = bit_of(5), .cycle = 40, .value = 1};
  last.evidence[1] = {.cause = bit_of(9), .cycle = 41, .value = 2};  // a warning
  last.evidence[2] = {.cause = bit_of(3), .cycle = 42, .value = 3};
  evidence_.restore(last);
  EXPECT_EQ(causes(), (Causes{bit_of(5), bit_of(3)}));
  EXPECT_EQ(written()[1].cycle, 42u);
  evidence_.latch(active_with(bit_of(3), Reaction::kBrake), 50);
  EXPECT_EQ(causes(), (Causes{bit_of(5), bit_of(3)})) << "it was latched already";
}

TEST_F(EvidenceOf, ACauseThatComesBackAfterAResetIsNew) {
  evidence_.latch(active_with(bit_of(3), Reaction::kBrake), 7);
  evidence_.clear();
  EXPECT_EQ(causes(), Causes());
  evidence_.latch(active_with(bit_of(3), Reaction::kBrake), 9);
  EXPECT_EQ(written()[0].cycle, 9u);
}

TEST(SupervisorOf, ANewMonitorHasLatchedAndRefusedNothing) {
  const Supervisor supervisor(300);
  EXPECT_EQ(supervisor.state(), SupervisorState::kInit);
  EXPECT_EQ(supervisor.causes() | supervisor.first_cause() | supervisor.stops(), 0u);
  EXPECT_EQ(supervisor.since_cycle() | supervisor.ramp_until() | supervisor.reset_refusal(), 0u);
}

TEST(SupervisorOf, AnEarlierMonitorTakesOverEachCauseThatThereIs) {
  for (std::size_t bit = 0; bit <= kStopCauses; ++bit) {
    Supervisor supervisor(300);
    supervisor.restore(bit_of(bit), 0);
    EXPECT_EQ(supervisor.causes(), bit < kStopCauses ? std::uint64_t{bit_of(bit)} : 0) << bit;
  }
}

TEST(SupervisorOf, TheFirstCauseOfAnEarlierMonitorStaysTheFirst) {
  Supervisor supervisor(300);
  supervisor.restore(bit_of(3) | bit_of(5), bit_of(5));
  supervisor.restore(bit_of(1), bit_of(1));
  EXPECT_EQ(supervisor.first_cause(), std::uint64_t{bit_of(5)});
}

TEST(SupervisorOf, AStopIsResetOnRequestAlone) {
  Supervisor supervisor(300);
  supervisor.step({.cycle = 1, .brake = bit_of(3)});
  SupervisorInput rest{.cycle = 2, .released = true, .motion_refusal = 0, .standing = true};
  supervisor.step(rest);
  EXPECT_EQ(supervisor.state(), SupervisorState::kStopped);
  rest.reset_requested = true;
  supervisor.step(rest);
  EXPECT_EQ(supervisor.state(), SupervisorState::kReady);
}

TEST(SupervisorOf, ANewMonitorCountsEachCauseThatLatchesOnce) {
  Supervisor supervisor(300);
  for (std::uint64_t cycle = 1; cycle < 4; ++cycle) supervisor.step({.cycle = cycle, .brake = bit_of(3)});
  EXPECT_EQ(supervisor.stops(), 1u);
  supervisor.step({.cycle = 4, .brake = bit_of(3), .ramp = bit_of(4)});
  EXPECT_EQ(supervisor.stops(), 2u);
}

TEST(SupervisorOf, ANewRunHasNoRamp) {
  Supervisor supervisor(300);
  supervisor.step({.cycle = 1, .released = true});
  supervisor.step({.cycle = 2, .ramp = bit_of(4), .released = true});
  EXPECT_EQ(supervisor.ramp_until(), 302u);
  supervisor.enter_run();
  EXPECT_EQ(supervisor.ramp_until(), 0u);
}

TEST(Warnings, EndASecondAfterTheirCondition) {
  Warnings warnings(kTick);
  EXPECT_EQ(warnings.bits(), 0u);
  const ActiveCauses none;
  warnings.step(active_with(bit_of(3), Reaction::kWarn), 1, 1);
  warnings.step(none, 61, 60);
  warnings.step(none, 101, 40);
  EXPECT_EQ(warnings.bits(), std::uint64_t{bit_of(3)});
  warnings.step(none, 102, 1);
  EXPECT_EQ(warnings.bits(), 0u);
}

TEST(Warnings, EachEndsByItself) {
  Warnings warnings(kTick);
  warnings.step(active_with(bit_of(0), Reaction::kSlow), 1, 1);
  warnings.step(active_with(bit_of(4), Reaction::kWarn, 12), 51, 50);
  EXPECT_TRUE(warnings.slowing());
  EXPECT_EQ(warnings.bits(), bit_of(0) | bit_of(4));
  warnings.step({}, 111, 60);
  EXPECT_FALSE(warnings.slowing());
  EXPECT_EQ(warnings.bits(), std::uint64_t{bit_of(4)});
  EXPECT_EQ(warnings.evidence(bit_of(4)).value, 12);
}

TEST(Warnings, OneThatComesBackInTimeIsTheSameAndLaterAnother) {
  Warnings warnings(kTick);
  warnings.step(active_with(bit_of(3), Reaction::kWarn, 11), 1, 1);
  warnings.step(active_with(bit_of(3), Reaction::kWarn, 12), 51, 50);
  EXPECT_EQ(warnings.evidence(bit_of(3)).cycle, 1u);
  EXPECT_EQ(warnings.evidence(bit_of(3)).value, 12);
  warnings.step({}, 200, 149);
  warnings.step(active_with(bit_of(3), Reaction::kWarn, 13), 201, 1);
  EXPECT_EQ(warnings.evidence(bit_of(3)).cycle, 201u);
}

TEST(Warnings, StopsAreNone) {
  Warnings warnings(kTick);
  ActiveCauses active = active_with(bit_of(3), Reaction::kBrake);
  active.add(bit_of(4), Reaction::kWarn);
  warnings.step(active, 1, 1);
  EXPECT_EQ(warnings.bits(), std::uint64_t{bit_of(4)});
  EXPECT_FALSE(warnings.slowing());
}

TEST(Warnings, EndWithTheRun) {
  Warnings warnings(kTick);
  ActiveCauses active = active_with(bit_of(3), Reaction::kSlow);
  active.add(bit_of(4), Reaction::kWarn);
  warnings.step(active, 1, 1);
  warnings.enter_run();
  EXPECT_EQ(warnings.bits(), 0u);
  EXPECT_FALSE(warnings.slowing());
}

}  // namespace robot_control::tests
