#include "drivers/cia402/power_state.h"

#include <algorithm>
#include <iterator>

namespace robot_control::cia402 {
namespace {

struct StateRow {
  PowerState state;
  std::uint16_t mask, statusword;
  const char* words;
};

using enum PowerState;

constexpr StateRow kStates[] = {
    {kNotReadyToSwitchOn, 0x4F, 0x00, "not ready to switch on"},
    {kSwitchOnDisabled, 0x4F, 0x40, "switch on disabled"},
    {kReadyToSwitchOn, 0x6F, 0x21, "ready to switch on"},
    {kSwitchedOn, 0x6F, 0x23, "switched on"},
    {kOperationEnabled, 0x6F, 0x27, "operation enabled"},
    {kQuickStopActive, 0x6F, 0x07, "quick stop active"},
    {kFaultReactionActive, 0x4F, 0x0F, "fault reaction active"},
    {kFault, 0x4F, 0x08, "fault"},
    {kUnknown, 0xFFFF, 0xFFFF, "unknown state"},
};

const StateRow& row_of(PowerState state) noexcept {
  const auto* const found = std::ranges::find(kStates, state, &StateRow::state);
  return found == std::end(kStates) ? *std::prev(std::end(kStates)) : *found;
}

}  // namespace

PowerState power_state(std::uint16_t statusword) noexcept {
  const auto* const found = std::ranges::find_if(
      kStates, [statusword](const StateRow& row) { return (statusword & row.mask) == row.statusword; });
  return found == std::end(kStates) ? kUnknown : found->state;
}

std::uint16_t statusword_of(PowerState state) noexcept {
  return row_of(state).statusword;
}

const char* power_state_words(PowerState state) noexcept {
  return row_of(state).words;
}

std::uint16_t step_to_operation(PowerState state) noexcept {
  switch (state) {
    case kSwitchOnDisabled:
      return Controlword::kShutdown;
    case kReadyToSwitchOn:
      return Controlword::kSwitchOn;
    case kSwitchedOn:
    case kOperationEnabled:
      return Controlword::kEnableOperation;
    default:
      return Controlword::kDisableVoltage;
  }
}

}  // namespace robot_control::cia402
