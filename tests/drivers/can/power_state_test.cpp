#include "drivers/can/cia402/power_state.h"

#include <gtest/gtest.h>

#include <set>

namespace robot_control::cia402 {
namespace {

using enum PowerState;

constexpr PowerState kAll[] = {kNotReadyToSwitchOn, kSwitchOnDisabled, kReadyToSwitchOn,     kSwitchedOn,
                               kOperationEnabled,   kQuickStopActive,  kFaultReactionActive, kFault};

TEST(PowerState, TheStatuswordsOfRealDrivesAreRead) {
  EXPECT_EQ(power_state(0x0650), kSwitchOnDisabled);
  EXPECT_EQ(power_state(0x0631), kReadyToSwitchOn);
  EXPECT_EQ(power_state(0x0633), kSwitchedOn);
  EXPECT_EQ(power_state(0x1637), kOperationEnabled);
  EXPECT_EQ(power_state(0x0617), kQuickStopActive);
  EXPECT_EQ(power_state(0x0618), kFault);
  EXPECT_EQ(power_state(0x061F), kFaultReactionActive);
  EXPECT_EQ(power_state(0x0000), kNotReadyToSwitchOn);
}

/// The table of the standard in its own writing.
std::set<PowerState> states_of(std::uint16_t statusword) {
  const std::pair<const char*, PowerState> table[] = {
      {"x0xx0000", kNotReadyToSwitchOn},  {"x1xx0000", kSwitchOnDisabled},
      {"x01x0001", kReadyToSwitchOn},     {"x01x0011", kSwitchedOn},
      {"x01x0111", kOperationEnabled},    {"x00x0111", kQuickStopActive},
      {"x0xx1111", kFaultReactionActive}, {"x0xx1000", kFault}};
  std::set<PowerState> found;
  for (const auto& [pattern, state] : table) {
    bool equal = true;
    for (unsigned i = 0; i < 8; ++i) {
      const char bit = (statusword >> (7 - i) & 1) != 0 ? '1' : '0';
      equal = equal && (pattern[i] == 'x' || pattern[i] == bit);
    }
    if (equal) found.insert(state);
  }
  if (found.empty()) found.insert(kUnknown);
  return found;
}

TEST(PowerState, EveryStatuswordHasTheStateOfTheTable) {
  for (std::uint32_t statusword = 0; statusword <= 0xFFFF; ++statusword) {
    const auto word = static_cast<std::uint16_t>(statusword);
    ASSERT_EQ(states_of(word), std::set{power_state(word)}) << std::hex << statusword;
  }
}

TEST(PowerState, AStatuswordOfAStateIsReadAsIt) {
  for (const PowerState state : kAll) EXPECT_EQ(power_state(statusword_of(state)), state) << power_state_words(state);
}

TEST(PowerState, EachStepLeadsTowardsOperationAndIsATransition) {
  PowerState state = kSwitchOnDisabled;
  for (const PowerState next : {kReadyToSwitchOn, kSwitchedOn, kOperationEnabled}) {
    EXPECT_EQ(transition(state, next), step_to_operation(state));
    state = next;
  }
  EXPECT_EQ(step_to_operation(kOperationEnabled), Controlword::kEnableOperation);
}

TEST(PowerState, AFaultIsNotResetByAStep) {
  EXPECT_EQ(step_to_operation(kFault), Controlword::kDisableVoltage);
  EXPECT_EQ(step_to_operation(kFaultReactionActive), Controlword::kDisableVoltage);
  EXPECT_EQ(step_to_operation(kUnknown), Controlword::kDisableVoltage);
  EXPECT_EQ(transition(kFault, kSwitchOnDisabled), Controlword::kFaultReset);
}

/// Returns whether a controlword is this command of the standard: a pattern of the bits 7 and 3 … 0.
bool commands(std::uint16_t controlword, const char* pattern) {
  const unsigned bits[] = {7, 3, 2, 1, 0};
  for (unsigned i = 0; i < 5; ++i) {
    const char bit = (controlword >> bits[i] & 1) != 0 ? '1' : '0';
    if (pattern[i] != 'x' && pattern[i] != bit) return false;
  }
  return true;
}

TEST(PowerState, EveryTransitionHasTheCommandOfTheStandard) {
  const std::tuple<PowerState, PowerState, const char*> table[] = {
      {kSwitchOnDisabled, kReadyToSwitchOn, "0x110"}, {kReadyToSwitchOn, kSwitchedOn, "00111"},
      {kSwitchedOn, kOperationEnabled, "01111"},      {kOperationEnabled, kSwitchedOn, "00111"},
      {kSwitchedOn, kReadyToSwitchOn, "0x110"},       {kReadyToSwitchOn, kSwitchOnDisabled, "0xx0x"},
      {kOperationEnabled, kReadyToSwitchOn, "0x110"}, {kOperationEnabled, kSwitchOnDisabled, "0xx0x"},
      {kSwitchedOn, kSwitchOnDisabled, "0xx0x"},      {kOperationEnabled, kQuickStopActive, "0x01x"},
      {kQuickStopActive, kSwitchOnDisabled, "0xx0x"}, {kFault, kSwitchOnDisabled, "1xxxx"},
      {kQuickStopActive, kOperationEnabled, "01111"}};
  std::size_t known = 0;
  for (const auto& [from, to, pattern] : table) {
    const auto controlword = transition(from, to);
    ASSERT_TRUE(controlword) << power_state_words(from) << " to " << power_state_words(to);
    EXPECT_TRUE(commands(*controlword, pattern)) << power_state_words(from) << " to " << power_state_words(to);
  }
  for (const PowerState from : kAll) {
    for (const PowerState to : kAll) known += transition(from, to).has_value() ? 1 : 0;
  }
  EXPECT_EQ(known, std::size(table));
}

}  // namespace
}  // namespace robot_control::cia402
