#pragma once
/// Cia402Parameters are the statements of the drive file about one axis of a CiA 402 drive.

#include <cstdint>
#include <utility>
#include <vector>

#include "drivers/drive_parameters.h"

namespace robot_control::cia402 {

enum class ModeChoice : std::uint8_t {
  kAny,  ///< the cyclic mode of torque or velocity (robot.wheel_command), else its profile mode, by 6502
  kCyclicTorque,
  kProfileTorque,
  kCyclicVelocity,
  kProfileVelocity,
};

inline std::vector<Word> words_of(ModeChoice) {
  using enum ModeChoice;
  return {{"any", kAny},
          {"cst", kCyclicTorque},
          {"tq", kProfileTorque},
          {"csv", kCyclicVelocity},
          {"pv", kProfileVelocity}};
}

inline bool is_of_speeds(ModeChoice mode) noexcept {
  return mode == ModeChoice::kCyclicVelocity || mode == ModeChoice::kProfileVelocity;
}

enum class PdoSource : std::uint8_t {
  kWritten,  ///< The mapping is written to the drive and read back.
  kFixed,    ///< The mapping is read from the drive.
};

inline std::vector<Word> words_of(PdoSource) {
  return {{"written", PdoSource::kWritten}, {"fixed", PdoSource::kFixed}};
}

/// Whether 606C is mapped to a second TPDO. Without it the velocity is the difference of positions.
enum class VelocityPdo : std::uint8_t {
  kDerived,  ///< where the bus has room, the unit is known and the drive maps it
  kTrue,     ///< refused where the drive does not map it
  kOff,
};

inline std::vector<Word> words_of(VelocityPdo) {
  return {{"derived", VelocityPdo::kDerived}, {"true", VelocityPdo::kTrue}, {"off", VelocityPdo::kOff}};
}

struct Cia402Parameters {
  DriveParameters drive{};
  std::uint64_t axis = 0;              ///< of a drive with two axes: 1 has its objects at 6800 and its PDOs 3 and 4
  ModeChoice mode = ModeChoice::kAny;  ///< others than `any` outweigh 6502
  PdoSource pdos = PdoSource::kWritten;
  VelocityPdo velocity_pdo = VelocityPdo::kDerived;
  bool velocity_has_room = true;       ///< on the bus; not of the drive file
  double rated_torque = 0;             ///< N·m, of the motor; 0: 6076
  double counts_per_turn = 0;          ///< of 6064 and the motor; 0: 608F
  double velocity_unit = 0;            ///< rad/s of one unit of 606C; 0: 60A9, and 1 rpm with VelocityPdo::kTrue
  double torque_slope = 0;             ///< N·m/s, of the motor, in tq; 0: the drive's own
  std::uint64_t vendor = 0;            ///< 1018:1; 0: not compared
  std::uint64_t product = 0;           ///< 1018:2; 0: not compared
  double host_timeout = 0.1;           ///< s without the host's heartbeat, after which the drive reacts (1016)
  std::int64_t quick_stop_option = 6;  ///< 605A
  std::int64_t abort_option = 3;       ///< 6007
  std::int64_t fault_reaction = 2;     ///< 605E

  std::pair<std::uint64_t, std::uint64_t> place() const noexcept { return {drive.node, axis}; }
};

inline Keys keys(Cia402Parameters& p) {
  constexpr double kMaxWord = 4294967295.0;
  return joined({keys(p.drive),
                 {
                     {"axis", &p.axis, {}, 0, 1, kOptional},
                     {"mode", &p.mode, {}, 0, 0, kOptional},
                     {"pdos", &p.pdos, {}, 0, 0, kOptional},
                     {"velocity_pdo", &p.velocity_pdo, {}, 0, 0, kOptional},
                     {"rated_torque", &p.rated_torque, "N·m", 0.001, 1.0e5, kOptional | kZeroIsOff},
                     {"counts_per_turn", &p.counts_per_turn, {}, 1, 1.0e9, kOptional | kZeroIsOff},
                     {"velocity_unit", &p.velocity_unit, "rad/s", 1.0e-9, 1.0e3, kOptional | kZeroIsOff},
                     {"torque_slope", &p.torque_slope, "N·m/s", 0.001, 1.0e6, kOptional | kZeroIsOff},
                     {"vendor", &p.vendor, {}, 0, kMaxWord, kOptional},
                     {"product", &p.product, {}, 0, kMaxWord, kOptional},
                     {"host_timeout", &p.host_timeout, "s", 0.01, 10, kOptional},
                     {"quick_stop_option", &p.quick_stop_option, {}, 0, 7, kOptional},
                     {"abort_option", &p.abort_option, {}, 0, 3, kOptional},
                     {"fault_reaction", &p.fault_reaction, {}, 0, 4, kOptional},
                 }});
}

}  // namespace robot_control::cia402
