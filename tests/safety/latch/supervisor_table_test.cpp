#include "safety/latch/supervisor_table.h"

#include <gtest/gtest.h>

#include "safety/latch/fixed_reactions.h"
#include "signals/names.h"

namespace robot_control::tests {

using enum SupervisorState;
using enum Trigger;

constexpr std::array kStates{kInit, kReady, kDrive, kStopping, kStopped, kFault};

SupervisorState after(SupervisorState state, std::initializer_list<Trigger> triggers) {
  TriggerSet set;
  for (const Trigger trigger : triggers) set.add(trigger);
  return next_state(state, set);
}

// Repeats the specification as a full matrix, independently of the table.
TEST(SupervisorTable, EveryStateAnswersEveryTriggerAsSpecified) {
  const std::map<SupervisorState, std::array<SupervisorState, kTriggers>> expected{
      // fault, brake, ramp, ramp ended, unreleased, reset incomplete, reset complete, complete, motion, rest
      {kInit, {kFault, kStopped, kStopped, kInit, kInit, kInit, kInit, kReady, kInit, kInit}},
      {kReady, {kFault, kStopped, kStopping, kReady, kInit, kReady, kReady, kReady, kDrive, kReady}},
      {kDrive, {kFault, kStopped, kStopping, kDrive, kInit, kDrive, kDrive, kDrive, kDrive, kReady}},
      {kStopping,
       {kFault, kStopped, kStopping, kStopped, kStopped, kStopping, kStopping, kStopping, kStopping, kStopping}},
      {kStopped, {kFault, kStopped, kStopped, kStopped, kStopped, kInit, kReady, kStopped, kStopped, kStopped}},
      {kFault, {kFault, kFault, kFault, kFault, kFault, kInit, kReady, kFault, kFault, kFault}},
  };
  for (const SupervisorState state : kStates) {
    for (std::size_t i = 0; i < kTriggers; ++i) {
      EXPECT_EQ(after(state, {static_cast<Trigger>(i)}), expected.at(state)[i])
          << name_of(state) << " on trigger " << i;
    }
  }
}

TEST(SupervisorTable, OfEverySetOfTriggersTheSeverestThatFitsWins) {
  constexpr std::array kBySeverity{kFaultCause,      kBrakeCause,    kRampCause, kUnreleased, kRampEnded,
                                   kResetIncomplete, kResetComplete, kComplete,  kMotion,     kRest};
  static_assert(kBySeverity.size() == kTriggers);
  for (const SupervisorState state : kStates) {
    for (unsigned set = 0; set < 1u << kTriggers; ++set) {
      TriggerSet triggers;
      SupervisorState expected = state;
      for (std::size_t i = kTriggers; i-- > 0;) {
        if ((set >> i & 1u) == 0) continue;
        triggers.add(kBySeverity[i]);
        for (const Transition& row : kTransitions) {
          if (row.from == state && row.trigger == kBySeverity[i]) expected = row.to;
        }
      }
      ASSERT_EQ(next_state(state, triggers), expected) << name_of(state) << ", triggers " << set;
    }
  }
}

TEST(SupervisorTable, NoSetOfTriggersLeavesALatchWithACauseOrWithoutAReset) {
  for (const SupervisorState state : {kStopped, kFault}) {
    for (unsigned set = 0; set < 1u << kTriggers; ++set) {
      TriggerSet triggers;
      for (std::size_t i = 0; i < kTriggers; ++i) triggers.add(static_cast<Trigger>(i), (set >> i & 1u) != 0);
      const SupervisorState next = next_state(state, triggers);
      const bool reset = triggers.holds(kResetComplete) || triggers.holds(kResetIncomplete);
      const bool latched = triggers.holds(kFaultCause) || triggers.holds(kBrakeCause) || triggers.holds(kRampCause);
      const bool released = next != kStopped && next != kFault;
      ASSERT_FALSE(released && (latched || !reset)) << name_of(state) << ", triggers " << set;
      ASSERT_FALSE(triggers.holds(kFaultCause) && next != kFault) << name_of(state) << ", triggers " << set;
    }
  }
}

TEST(SupervisorTable, OnlyReadyAndDrivePermitDriving) {
  for (const SupervisorState state : kStates) {
    EXPECT_EQ(action_in(state) == PermitAction::kDrive, state == kReady || state == kDrive) << name_of(state);
  }
  EXPECT_EQ(action_in(kStopping), PermitAction::kRamp);
  EXPECT_EQ(action_in(static_cast<SupervisorState>(99)), PermitAction::kBrake);
}

TEST(FixedReactions, NoCauseHasTwo) {
  std::uint64_t all = 0;
  for (const FixedCause& row : kFixedCauses) {
    EXPECT_EQ(all & row.cause, 0u) << row_of(kStopCauseNames, row.cause)->name;
    all |= row.cause;
  }
}

TEST(FixedReactions, OnlyTheHeartbeatRampsAndOnlyTheDriversFaultsLeadToFault) {
  EXPECT_EQ(causes_of(FixedReaction::kRamp), std::uint64_t{kCauseHeartbeatLost});
  EXPECT_EQ(causes_of(FixedReaction::kFault), kCauseDriverFault | kCauseGateDisobeys | kCauseMachineNotReady);
}

TEST(Names, SpeakOfEveryBitThatIsSet) {
  EXPECT_EQ(names_of(kStopCauseNames, kCauseControllerLost | kCauseHeartbeatLost), "controller_lost heartbeat_lost");
  EXPECT_EQ(names_of(kStopCauseNames, 0), "");
  EXPECT_EQ(sentences_of(kResetRefusalNames, kRefusalMoving, {}),
            "the robot still moves (wait until every joint stands still)");
  EXPECT_EQ(name_of(static_cast<SupervisorState>(99)), "UNKNOWN");
}

}  // namespace robot_control::tests
