#pragma once
/// CanParameters are the statements of the drive file about a bus and all drives on it.

#include <string>
#include <variant>
#include <vector>

#include "drivers/cia402/cia402_parameters.h"
#include "drivers/odrive/odrive_parameters.h"
#include "drivers/vesc/vesc_parameters.h"

namespace robot_control {

enum class CanDialect : std::uint8_t { kOdrive, kCia402, kVesc };

inline std::vector<Word> words_of(CanDialect) {
  return {{"odrive", CanDialect::kOdrive}, {"cia402", CanDialect::kCia402}, {"vesc", CanDialect::kVesc}};
}

struct CanBusParameters {
  CanDialect dialect = CanDialect::kOdrive;
  std::string address = "can0";   ///< can_socket.h
  double bit_rate = 1.0e6;        ///< bit/s, as set on the interface
  std::uint64_t host_node = 127;  ///< of this program, for the heartbeat that CANopen drives expect
};

inline Keys keys(CanBusParameters& bus) {
  return {
      {"dialect", &bus.dialect},
      {"address", &bus.address, {}, 0, 0, kOptional},
      {"bit_rate", &bus.bit_rate, "bit/s", 10000, 1.0e6, kOptional},
      {"host_node", &bus.host_node, {}, 1, 127, kOptional},
  };
}

struct CanParameters {
  CanBusParameters bus;
  /// In the order of the robot's joints.
  std::variant<std::vector<odrive::OdriveParameters>, std::vector<cia402::Cia402Parameters>,
               std::vector<vesc::VescParameters>>
      joints;
};

}  // namespace robot_control
