#pragma once
/// Objects of CiA 402 with which a drive is set up and driven, and its process data. The modes are cyclic synchronous
/// torque (CST) and profile torque (TQ), or the same of the velocity (CSV, PV). A drive with several axes repeats all
/// 6xxx with 800 more per axis. Sources: CiA 402-2; CiA 301 for 1xxx.

#include "drivers/cia402/pdo.h"

namespace robot_control::cia402 {

using canopen::ObjectAddress;
using canopen::Pdo;
using canopen::PdoEntry;
using canopen::PdoKind;

/// Modes of operation: values of 6060 and 6061; bit (value − 1) of 6502 says that the drive has it.
enum class Mode : std::int8_t {
  kProfileVelocity = 3,
  kTorque = 4,
  kCyclicVelocity = 9,
  kCyclicTorque = 10,
};

constexpr bool supports(std::uint32_t supported_modes, Mode mode) noexcept {
  return (supported_modes >> (static_cast<unsigned>(mode) - 1) & 1U) != 0;
}

inline constexpr ObjectAddress kHeartbeatConsumer{0x1016, 1};  ///< canopen::heartbeat_consumer
inline constexpr ObjectAddress kHeartbeatProducer{0x1017, 0};  ///< u16, ms
inline constexpr ObjectAddress kVendor{0x1018, 1}, kProduct{0x1018, 2}, kRevision{0x1018, 3}, kSerialNumber{0x1018, 4};
inline constexpr ObjectAddress kDeviceName{0x1008, 0};             ///< text, read in segments
inline constexpr ObjectAddress kErrorBehaviour{0x1029, 1};         ///< 0 pre-operational, 1 no change, 2 stopped
inline constexpr ObjectAddress kAbortConnectionOption{0x6007, 0};  ///< 0 none, 1 fault, 2 disable voltage, 3 quick stop
inline constexpr ObjectAddress kErrorCode{0x603F, 0};              ///< u16, canopen::error_code_words
inline constexpr ObjectAddress kQuickStopOption{0x605A, 0};  ///< 0 coast, 1 ramp, 2 quick-stop ramp, 5 – 7 and hold
inline constexpr ObjectAddress kFaultReactionOption{0x605E, 0};  ///< 0 coast, 1 ramp, 2 quick-stop ramp
inline constexpr ObjectAddress kModeOfOperation{0x6060, 0}, kModeDisplay{0x6061, 0}, kSupportedModes{0x6502, 0};
inline constexpr ObjectAddress kMaxTorque{0x6072, 0};      ///< u16, ‰ of rated torque
inline constexpr ObjectAddress kRatedTorque{0x6076, 0};    ///< u32, mN·m
inline constexpr ObjectAddress kTorqueSlope{0x6087, 0};    ///< u32, ‰ of rated torque per second; TQ alone
inline constexpr ObjectAddress kDcLinkVoltage{0x6079, 0};  ///< u32, mV
inline constexpr ObjectAddress kVelocityUnit{0x60A9, 0};   ///< u32, unit of 606C (drive_units.h)
inline constexpr ObjectAddress kPeriodValue{0x60C2, 1}, kPeriodIndex{0x60C2, 2};  ///< value · 10^index s

inline constexpr PdoEntry kControlwordEntry{{0x6040, 0}, 16, false};
inline constexpr PdoEntry kTargetTorqueEntry{{0x6071, 0}, 16, true};
inline constexpr PdoEntry kTargetVelocityEntry{{0x60FF, 0}, 32, true};  ///< unit of 606C
inline constexpr PdoEntry kStatuswordEntry{{0x6041, 0}, 16, false};
inline constexpr PdoEntry kPositionEntry{{0x6064, 0}, 32, true};
inline constexpr PdoEntry kTorqueEntry{{0x6077, 0}, 16, true};
inline constexpr PdoEntry kVelocityEntry{{0x606C, 0}, 32, true};

/// The velocity comes with every second SYNC. It is used to move positions on over a period (late_position.h), and to
/// brake. Two drives at 1 kHz then load a bus of 1 Mbit/s with less than 70 %.
inline constexpr std::uint8_t kVelocitySyncs = 2;

/// The process data of one axis: 4 bytes to the drive, or 6 with a velocity, and 8 bytes from it in each cycle. The
/// velocity has no room in the first TPDO; where the drive cannot send a second one, velocity follows from the
/// position.
struct AxisPdos {
  Pdo command{PdoKind::kReceive, 1, {kControlwordEntry, kTargetTorqueEntry}};
  Pdo state{PdoKind::kTransmit, 1, {kStatuswordEntry, kPositionEntry, kTorqueEntry}};
  Pdo velocity{PdoKind::kTransmit, 2, {kVelocityEntry}};
};

/// Returns the same object of axis 0, 1, 2 … of one node.
constexpr ObjectAddress on_axis(const ObjectAddress& object, unsigned axis) noexcept {
  if (object.index < 0x6000) return object;
  return {.index = static_cast<std::uint16_t>(object.index + 0x800 * axis), .sub = object.sub};
}

/// Returns the process data of this axis of a drive that takes torques, or speeds.
inline AxisPdos pdos_of(unsigned axis, bool takes_speeds) noexcept {
  AxisPdos pdos;
  if (takes_speeds) pdos.command.mapping.entries[1] = kTargetVelocityEntry;
  for (Pdo* pdo : {&pdos.command, &pdos.state, &pdos.velocity}) {
    pdo->number = static_cast<std::uint8_t>(pdo->number + 2 * axis);
    for (PdoEntry& entry : pdo->mapping.entries) entry.object = on_axis(entry.object, axis);
  }
  return pdos;
}

}  // namespace robot_control::cia402
