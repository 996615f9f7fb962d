#include "drivers/cia402/power_state.h"

#include <gtest/gtest.h>

namespace robot_control::cia402::tests {

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

TEST(PowerState, EachStepIsTheCommandOfTheStandardTowardsOperation) {
  EXPECT_EQ(step_to_operation(kSwitchOnDisabled), 0x06);
  EXPECT_EQ(step_to_operation(kReadyToSwitchOn), 0x07);
  EXPECT_EQ(step_to_operation(kSwitchedOn), 0x0F);
  EXPECT_EQ(step_to_operation(kOperationEnabled), 0x0F);
}

TEST(PowerState, AFaultIsNotResetByAStep) {
  EXPECT_EQ(step_to_operation(kFault), Controlword::kDisableVoltage);
  EXPECT_EQ(step_to_operation(kFaultReactionActive), Controlword::kDisableVoltage);
  EXPECT_EQ(step_to_operation(kUnknown), Controlword::kDisableVoltage);
}

}  // namespace robot_control::cia402::tests
