#pragma once
/// The power state machine of a drive: its state in the statusword 6041, its commands in the controlword 6040.
///
///   xxxx xxxx x0xx 0000  not ready to switch on      xxxx xxxx x01x 0111  operation enabled
///   xxxx xxxx x1xx 0000  switch on disabled          xxxx xxxx x00x 0111  quick stop active
///   xxxx xxxx x01x 0001  ready to switch on          xxxx xxxx x0xx 1111  fault reaction active
///   xxxx xxxx x01x 0011  switched on                 xxxx xxxx x0xx 1000  fault
///
/// The motor has torque in operation enabled, quick stop active and fault reaction active.
/// Source: CiA 402-2 (IEC 61800-7-201), state machine and tables of statusword and controlword.

#include <cstdint>

namespace robot_control::cia402 {

enum class PowerState : std::uint8_t {
  kUnknown,  ///< a statusword outside of the table
  kNotReadyToSwitchOn,
  kSwitchOnDisabled,
  kReadyToSwitchOn,
  kSwitchedOn,
  kOperationEnabled,
  kQuickStopActive,
  kFaultReactionActive,
  kFault,
};

PowerState power_state(std::uint16_t statusword) noexcept;

/// The smallest statusword of a state; 0xFFFF for kUnknown.
std::uint16_t statusword_of(PowerState state) noexcept;

const char* power_state_words(PowerState state) noexcept;

struct StatusBits {
  static constexpr std::uint16_t kVoltageEnabled = 1U << 4U;
  static constexpr std::uint16_t kWarning = 1U << 7U;
  static constexpr std::uint16_t kRemote = 1U << 9U;           ///< The drive obeys the controlword.
  static constexpr std::uint16_t kFollowsCommand = 1U << 12U;  ///< in the cyclic modes
};

struct Controlword {
  static constexpr std::uint16_t kDisableVoltage = 0x00;
  static constexpr std::uint16_t kQuickStop = 0x02;
  static constexpr std::uint16_t kShutdown = 0x06;
  static constexpr std::uint16_t kSwitchOn = 0x07;
  static constexpr std::uint16_t kEnableOperation = 0x0F;
  static constexpr std::uint16_t kFaultReset = 0x80;  ///< The rising edge of this bit counts.
};

/// Returns the controlword of the next step towards operation enabled, which holds in that state. It never resets a
/// fault: that needs the operator. In a state that only the drive leaves it is kDisableVoltage.
std::uint16_t step_to_operation(PowerState state) noexcept;

}  // namespace robot_control::cia402
