#include "drivers/odrive/odrive_errors.h"

#include "signals/formatted_text.h"

namespace robot_control::odrive {
namespace {

struct NamedBit {
  std::uint64_t bit;
  const char* name;
};

constexpr NamedBit kAxisNames05[] = {
    {0x1, "INVALID_STATE"},
    {0x40, "MOTOR_FAILED"},
    {0x80, "SENSORLESS_ESTIMATOR_FAILED"},
    {0x100, "ENCODER_FAILED"},
    {0x200, "CONTROLLER_FAILED"},
    {0x800, "WATCHDOG_TIMER_EXPIRED"},
    {0x1000, "MIN_ENDSTOP_PRESSED"},
    {0x2000, "MAX_ENDSTOP_PRESSED"},
    {0x4000, "ESTOP_REQUESTED"},
    {0x20000, "HOMING_WITHOUT_ENDSTOP"},
    {0x40000, "OVER_TEMP"},
    {0x80000, "UNKNOWN_POSITION"},
};

constexpr NamedBit kMotorNames05[] = {
    {0x1, "PHASE_RESISTANCE_OUT_OF_RANGE"},
    {0x2, "PHASE_INDUCTANCE_OUT_OF_RANGE"},
    {0x8, "DRV_FAULT"},
    {0x10, "CONTROL_DEADLINE_MISSED"},
    {0x80, "MODULATION_MAGNITUDE"},
    {0x400, "CURRENT_SENSE_SATURATION"},
    {0x1000, "CURRENT_LIMIT_VIOLATION"},
    {0x10000, "MODULATION_IS_NAN"},
    {0x20000, "MOTOR_THERMISTOR_OVER_TEMP"},
    {0x40000, "FET_THERMISTOR_OVER_TEMP"},
    {0x80000, "TIMER_UPDATE_MISSED"},
    {0x100000, "CURRENT_MEASUREMENT_UNAVAILABLE"},
    {0x200000, "CONTROLLER_FAILED"},
    {0x400000, "I_BUS_OUT_OF_RANGE"},
    {0x800000, "BRAKE_RESISTOR_DISARMED"},
    {0x1000000, "SYSTEM_LEVEL"},
    {0x2000000, "BAD_TIMING"},
    {0x4000000, "UNKNOWN_PHASE_ESTIMATE"},
    {0x8000000, "UNKNOWN_PHASE_VEL"},
    {0x10000000, "UNKNOWN_TORQUE"},
    {0x20000000, "UNKNOWN_CURRENT_COMMAND"},
    {0x40000000, "UNKNOWN_CURRENT_MEASUREMENT"},
    {0x80000000, "UNKNOWN_VBUS_VOLTAGE"},
    {0x100000000, "UNKNOWN_VOLTAGE_COMMAND"},
    {0x200000000, "UNKNOWN_GAINS"},
    {0x400000000, "CONTROLLER_INITIALIZING"},
    {0x800000000, "UNBALANCED_PHASES"},
};

constexpr NamedBit kEncoderNames05[] = {
    {0x1, "UNSTABLE_GAIN"},       {0x2, "CPR_POLEPAIRS_MISMATCH"},
    {0x4, "NO_RESPONSE"},         {0x8, "UNSUPPORTED_ENCODER_MODE"},
    {0x10, "ILLEGAL_HALL_STATE"}, {0x20, "INDEX_NOT_FOUND_YET"},
    {0x40, "ABS_SPI_TIMEOUT"},    {0x80, "ABS_SPI_COM_FAIL"},
    {0x100, "ABS_SPI_NOT_READY"}, {0x200, "HALL_NOT_CALIBRATED_YET"},
};

constexpr NamedBit kControllerNames05[] = {
    {0x1, "OVERSPEED"},
    {0x2, "INVALID_INPUT_MODE"},
    {0x4, "UNSTABLE_GAIN"},
    {0x8, "INVALID_MIRROR_AXIS"},
    {0x10, "INVALID_LOAD_ENCODER"},
    {0x20, "INVALID_ESTIMATE"},
    {0x40, "INVALID_CIRCULAR_RANGE"},
    {0x80, "SPINOUT_DETECTED"},
};

constexpr NamedBit kNames06[] = {
    {0x1, "INITIALIZING"},
    {0x2, "SYSTEM_LEVEL"},
    {0x4, "TIMING_ERROR"},
    {0x8, "MISSING_ESTIMATE"},
    {0x10, "BAD_CONFIG"},
    {0x20, "DRV_FAULT"},
    {0x40, "MISSING_INPUT"},
    {0x100, "DC_BUS_OVER_VOLTAGE"},
    {0x200, "DC_BUS_UNDER_VOLTAGE"},
    {0x400, "DC_BUS_OVER_CURRENT"},
    {0x800, "DC_BUS_OVER_REGEN_CURRENT"},
    {0x1000, "CURRENT_LIMIT_VIOLATION"},
    {0x2000, "MOTOR_OVER_TEMP"},
    {0x4000, "INVERTER_OVER_TEMP"},
    {0x8000, "VELOCITY_LIMIT_VIOLATION"},
    {0x10000, "POSITION_LIMIT_VIOLATION"},
    {0x1000000, "WATCHDOG_TIMER_EXPIRED"},
    {0x2000000, "ESTOP_REQUESTED"},
    {0x4000000, "SPINOUT_DETECTED"},
    {0x8000000, "BRAKE_RESISTOR_DISARMED"},
    {0x10000000, "THERMISTOR_DISCONNECTED"},
    {0x40000000, "CALIBRATION_ERROR"},
};

constexpr std::span<const NamedBit> kNames[] = {kAxisNames05, kMotorNames05, kEncoderNames05, kControllerNames05,
                                                kNames06};  // by ErrorKind

}  // namespace

std::string error_names(ErrorKind kind, std::uint64_t error) {
  if (error == 0) return "NONE";
  std::string text;
  for (const NamedBit& named : kNames[static_cast<std::size_t>(kind)]) {
    if ((error & named.bit) == 0) continue;
    text += text.empty() ? named.name : std::string(" ") + named.name;
    error &= ~named.bit;
  }
  if (error != 0) text += formatted("%s0x%llX", text.empty() ? "" : " ", static_cast<unsigned long long>(error));
  return text;
}

std::string error_words(std::uint64_t error, std::span<const std::uint64_t, 5> details) {
  if (details.back() == 1) {
    std::string text = error_names(ErrorKind::kAny06, error);
    if (details[3] != 0) text += " (disarmed by " + error_names(ErrorKind::kAny06, details[3]) + ")";
    return text;
  }
  std::string text = error_names(ErrorKind::kAxis05, error);
  constexpr ErrorKind kKinds[] = {ErrorKind::kMotor05, ErrorKind::kEncoder05, ErrorKind::kController05};
  for (std::size_t i = 0; i < std::size(kKinds); ++i) {
    if (details[i] != 0) text += " " + error_names(kKinds[i], details[i]);
  }
  return text;
}

}  // namespace robot_control::odrive
