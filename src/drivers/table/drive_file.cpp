#include "drivers/table/drive_file.h"

#include <algorithm>
#include <functional>
#include <numbers>

#include "configuration/loop_parameters.h"
#include "configuration/peer_file.h"
#include "drivers/line/can_load.h"
#include "drivers/drive/drive_set.h"
#include "drivers/odrive/odrive_codec.h"
#include "drivers/line/serial_port.h"
#include "parameters/tree_reader.h"

namespace robot_control {
namespace {

constexpr const char* kBus = "bus";
constexpr const char* kBoard = "board";
constexpr const char* kRoboclaw = "roboclaw";
constexpr const char* kEveryJoint = "every_joint";
constexpr double kMaxCountsUnseen = 32767;
constexpr double kMaxCountsPerSecond = 0x3FFFFFFF / 256.0;  // firmware/board.c
constexpr double kMinTimeoutPeriods = 10;                   // in which a drive waits for its host

using cia402::Cia402Parameters;
using odrive::OdriveParameters;
using vesc::VescParameters;

std::string block_of(const std::string& path) {
  return path.substr(0, path.find('.'));
}

/// Moves the block out of the tree.
ParameterTree extracted(ParameterTree& tree, const std::string& block) {
  ParameterTree part;
  std::erase_if(tree.entries, [&](const auto& entry) {
    if (block_of(entry.first) != block) return false;
    part.entries.insert(entry);
    return true;
  });
  std::erase_if(tree.blocks, [&](const BlockEntry& entry) {
    if (entry.name != block) return false;
    part.blocks.push_back(entry);
    return true;
  });
  return part;
}

bool takes_speeds(const Parameters& parameters) {
  return parameters.robot.wheel_command == WheelCommand::kVelocity;
}

/// Returns the largest number of counts between two reports.
double counts_unseen(const BoardWheelParameters& wheel, const BoardLineParameters& line, double rate) {
  const double seconds = (static_cast<double>(line.max_silence) + 1) / rate;
  return wheel.velocity_limit * seconds * wheel.counts_per_turn / (2 * std::numbers::pi);
}

/// A DriveFileReader collects the problems of one file.
class DriveFileReader {
 public:
  DriveFileReader(const std::string& path, std::span<const std::string> joints, double rate, bool takes_speeds)
      : path_(path),
        joints_(joints),
        rate_(rate),
        takes_speeds_(takes_speeds),
        tree_(read_tree(path, {}, problems_, &peer_problem)) {}

  BoardParameters read_board() {
    BoardParameters board;
    board.takes_speeds = takes_speeds_;
    read_serial(kBoard, board);
    return board;
  }

  RoboclawParameters read_roboclaw() {
    RoboclawParameters board;
    read_serial(kRoboclaw, board);
    return board;
  }

  CanParameters read() {
    const std::string subject = begin();
    CanParameters can;
    bool known_dialect = false;
    read_block(kBus, keys(can.bus), [&](GivenValues& given) { known_dialect = given.accepted("bus.dialect"); });
    if (!known_dialect) problems_.throw_if_any(subject);
    switch (can.bus.dialect) {
      case CanDialect::kOdrive:
        can.joints = read_joints<OdriveParameters>(can);
        break;
      case CanDialect::kCia402:
        can.joints = read_joints<Cia402Parameters>(can);
        break;
      case CanDialect::kVesc:
        can.joints = read_joints<VescParameters>(can);
        break;
    }
    problems_.throw_if_any(subject);
    std::vector<PlannedFrames> plan = DriveSet(can, 1 / rate_).plan();
    if (auto* joints = std::get_if<std::vector<Cia402Parameters>>(&can.joints);
        joints != nullptr && bus_load(plan, rate_, can.bus.bit_rate) > kMaxBusLoad) {
      for (Cia402Parameters& joint : *joints) joint.velocity_has_room = false;
      plan = DriveSet(can, 1 / rate_).plan();
    }
    if (const auto problem = bus_load_problem(plan, rate_, can.bus.bit_rate, kMinRate)) {
      problems_.add({"bus.bit_rate", shortest(can.bus.bit_rate), *problem, path_, ""});
    }
    problems_.throw_if_any(subject);
    return can;
  }

 private:
  static Schema schema_of(std::vector<Block> blocks, std::function<void(const Schema&, GivenValues&)> check) {
    return {.blocks = std::move(blocks), .check = std::move(check), .other_package_remedy = [](std::string_view) {
              return std::string();
            }};
  }

  /// Returns the first sentence of the refusal, after a file without blocks was refused.
  std::string begin() {
    std::string subject = "drive file refused (" + path_ + ")";
    if (tree_.blocks.empty() && problems_.empty()) problems_.add({path_, "", "holds no blocks", "", ""});
    if (tree_.blocks.empty()) problems_.throw_if_any(subject);
    return subject;
  }

  template <class File>
  void read_serial(const std::string& block, File& file) {
    const std::string subject = begin();
    read_block(block.c_str(), keys(file.line), [&](GivenValues& given) {
      const std::uint64_t bit_rate = file.line.bit_rate;
      if (given.accepted(block + ".bit_rate") && bit_rate != 0 && !is_bit_rate(static_cast<unsigned>(bit_rate)))
        given.refuse(block + ".bit_rate", "is no bit rate of a tty", "take 115200, 460800, 921600 …, or 0 for USB");
    });
    file.wheels = read_joints<typename decltype(file.wheels)::value_type>(file);
    problems_.throw_if_any(subject);
  }

  /// Reads the block that is not a joint's.
  void read_block(const char* name, Keys keys, const std::function<void(GivenValues&)>& check) {
    const Schema schema =
        schema_of({{name, std::move(keys)}}, [&](const Schema&, GivenValues& given) { check(given); });
    read_blocks(extracted(tree_, name), schema, schema.blocks, path_, problems_);
  }

  template <class Parameters, class File>
  std::vector<Parameters> read_joints(const File& file) {
    Parameters all;
    set_defaults(all);
    Block every{kEveryJoint, keys(all)};
    for (Key& key : every.keys) key.traits |= kOptional;
    const Schema every_schema = schema_of({every}, [](const Schema&, GivenValues&) {});
    const ParameterTree common = extracted(tree_, kEveryJoint);
    read_blocks(common, every_schema, every_schema.blocks, path_, problems_);

    std::vector<Parameters> joints(joints_.size(), all);
    std::vector<Block> blocks;
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      name_joint(joints[i], joints_[i]);
      blocks.push_back({joints_[i], keys(joints[i])});
      for (Key& key : blocks.back().keys) {
        if (common.entries.contains(path_of(every, key))) key.traits |= kOptional;
      }
    }
    const Schema schema = schema_of(std::move(blocks), [&](const Schema&, GivenValues& given) {
      for (std::size_t i = 0; i < joints.size(); ++i) check_joint(joints, i, file, given);
    });
    read_blocks(std::move(tree_), schema, schema.blocks, path_, problems_);
    return joints;
  }

  /// Refuses the value of a joint, or that of every_joint.
  void refuse(GivenValues& given, const std::string& joint, const std::string& key, const std::string& rule,
              const std::string& remedy = "") {
    const std::string path = joint + "." + key;
    if (given.accepted(path)) return given.refuse(path, rule, remedy);
    if (!given.refused(path)) problems_.add({path, "", rule, path_, remedy});
  }

  template <class Parameters>
  void check_joint(const std::vector<Parameters>& joints, std::size_t i, const CanParameters& can, GivenValues& given) {
    const DriveParameters& drive = joints[i].drive;
    if (drive.direction == 0) refuse(given, drive.joint, "direction", "must be 1 or -1");
    check_dialect(joints[i], can, given);
    for (std::size_t j = 0; j < i; ++j) {
      if (same_axis(joints[i], joints[j]) && given.accepted(drive.joint + ".node")) {
        refuse(given, drive.joint, "node", "is the drive of " + joints[j].drive.joint + ", too",
               "each joint has its own");
      }
    }
  }

  template <class Parameters>
  static void name_joint(Parameters& joint, const std::string& name) {
    joint.drive.joint = name;
  }
  static void name_joint(BoardWheelParameters& wheel, const std::string& name) { wheel.joint = name; }
  static void name_joint(RoboclawWheelParameters& wheel, const std::string& name) { wheel.joint = name; }

  void check_joint(const std::vector<RoboclawWheelParameters>& wheels, std::size_t i,
                   const RoboclawParameters& /*file*/, GivenValues& given) {
    const RoboclawWheelParameters& wheel = wheels[i];
    if (wheel.direction == 0) refuse(given, wheel.joint, "direction", "must be 1 or -1");
    for (std::size_t j = 0; j < i; ++j) {
      if (wheels[j].motor == wheel.motor && given.accepted(wheel.joint + ".motor"))
        refuse(given, wheel.joint, "motor", "is the motor of " + wheels[j].joint + ", too", "each joint has its own");
    }
  }

  void check_joint(const std::vector<BoardWheelParameters>& wheels, std::size_t i, const BoardParameters& board,
                   GivenValues& given) {
    const BoardWheelParameters& wheel = wheels[i];
    if (wheel.direction == 0) refuse(given, wheel.joint, "direction", "must be 1 or -1");
    if (wheel.counter_bits != 16 && wheel.counter_bits != 32)
      refuse(given, wheel.joint, "counter_bits", "must be 16 or 32");
    if (takes_speeds_ && wheel.velocity_limit * wheel.counts_per_turn / (2 * std::numbers::pi) > kMaxCountsPerSecond) {
      refuse(given, wheel.joint, "velocity_limit",
             "must be below 4 194 303 counts per second, the greatest speed of an order",
             "lower it, or count fewer edges per turn");
    }
    if (wheel.counter_bits == 16 && counts_unseen(wheel, board.line, rate_) > kMaxCountsUnseen) {
      refuse(given, wheel.joint, "counter_bits",
             "must be 32: a counter of 16 bits wraps unseen within max_silence at this velocity_limit",
             "send counts of 32 bits, or lower max_silence");
    }
    for (std::size_t j = 0; j < i; ++j) {
      if (wheels[j].wheel == wheel.wheel && given.accepted(wheel.joint + ".wheel"))
        refuse(given, wheel.joint, "wheel", "is the wheel of " + wheels[j].joint + ", too", "each joint has its own");
    }
    if (wheel.wheel >= wheels.size() && given.accepted(wheel.joint + ".wheel"))
      refuse(given, wheel.joint, "wheel", "must be below the number of joints, " + std::to_string(wheels.size()));
  }

  /// Sets the values that follow from the rate where they are left out.
  void set_defaults(BoardWheelParameters& /*all*/) const {}
  void set_defaults(RoboclawWheelParameters& /*all*/) const {}
  template <class Parameters>
  void set_defaults(Parameters& all) const {
    all.drive.takes_speeds = takes_speeds_;
  }
  void set_defaults(Cia402Parameters& all) const {
    all.drive.takes_speeds = takes_speeds_;
    all.host_timeout = std::max(all.host_timeout, kMinTimeoutPeriods / rate_);
  }

  template <class Parameters>
  static bool same_axis(const Parameters& one, const Parameters& other) {
    return one.drive.node == other.drive.node;
  }
  static bool same_axis(const Cia402Parameters& one, const Cia402Parameters& other) {
    return one.drive.node == other.drive.node && one.axis == other.axis;
  }

  void check_dialect(const OdriveParameters& p, const CanParameters& /*can*/, GivenValues& given) {
    const DriveParameters& drive = p.drive;
    if (drive.node > odrive::kMaxNode) refuse(given, drive.joint, "node", "must be 0 … 63 on an ODrive");
    if (drive.on_silence == SilenceReaction::kBrakes || drive.on_silence == SilenceReaction::kHolds) {
      refuse(given, drive.joint, "on_silence", "must be coasts or unknown: an ODrive releases the motor");
    }
    if ((p.enable_watchdog_endpoint == 0) != (p.watchdog_timeout_endpoint == 0)) {
      const char* missing = p.enable_watchdog_endpoint == 0 ? "enable_watchdog_endpoint" : "watchdog_timeout_endpoint";
      refuse(given, drive.joint, missing, "is missing: both endpoints of the watchdog are needed, or none");
    }
    if (p.enable_watchdog_endpoint != 0 && p.firmware == odrive::Firmware::k05) {
      refuse(given, drive.joint, "firmware", "must not be 0.5, which has no endpoints on CAN");
    }
  }

  void check_dialect(const Cia402Parameters& p, const CanParameters& can, GivenValues& given) {
    if (p.drive.node == 0 || p.drive.node > canopen::kMaxNode || p.drive.node == can.bus.host_node) {
      refuse(given, p.drive.joint, "node", "must be 1 … 127 and not bus.host_node");
    }
    if (p.host_timeout < kMinTimeoutPeriods / rate_ * (1 - 1.0e-9)) {
      refuse(given, p.drive.joint, "host_timeout", "must be at least ten periods of the loop (robot.rate)",
             "a host that is late for a few cycles would stop the drive");
    }
    if (p.mode != cia402::ModeChoice::kAny && is_of_speeds(p.mode) != takes_speeds_) {
      refuse(given, p.drive.joint, "mode",
             takes_speeds_ ? "must be any, csv or pv with robot.wheel_command: velocity"
                           : "must be any, cst or tq with robot.wheel_command: torque",
             "correct it, or set robot.wheel_command");
    }
    if (p.abort_option == 0 && p.drive.on_silence != SilenceReaction::kUnknown) {
      refuse(given, p.drive.joint, "on_silence", "contradicts abort_option: 0, with which the drive does nothing",
             "leave one of them out");
    }
  }

  void check_dialect(const VescParameters& p, const CanParameters& /*can*/, GivenValues& given) {
    const DriveParameters& drive = p.drive;
    if (drive.on_silence == SilenceReaction::kHolds) {
      refuse(given, drive.joint, "on_silence",
             "must be coasts, brakes or unknown: the timeout of a VESC holds nothing at rest");
    }
    if (!takes_speeds_ && p.torque_constant == 0) {
      refuse(given, drive.joint, "torque_constant",
             "is missing: with robot.wheel_command: torque the currents follow from it",
             "state N·m per A of the motor, or set robot.wheel_command to velocity");
    }
  }

  const std::string& path_;
  std::span<const std::string> joints_;
  double rate_;
  bool takes_speeds_;
  ProblemList problems_;
  ParameterTree tree_;
};

}  // namespace

CanParameters read_drive_file(const Parameters& parameters, std::span<const std::string> joints) {
  return read_drive_file(parameters.drives, joints, parameters.loop.rate, takes_speeds(parameters));
}

RoboclawParameters read_roboclaw_file(const Parameters& parameters, std::span<const std::string> joints) {
  return DriveFileReader(parameters.drives, joints, parameters.loop.rate, true).read_roboclaw();
}

BoardParameters read_board_file(const Parameters& parameters, std::span<const std::string> joints) {
  return read_board_file(parameters.drives, joints, parameters.loop.rate, takes_speeds(parameters));
}

BoardParameters read_board_file(const std::string& path, std::span<const std::string> joints, double rate,
                                bool takes_speeds) {
  return DriveFileReader(path, joints, rate, takes_speeds).read_board();
}

CanParameters read_drive_file(const std::string& path, std::span<const std::string> joints, double rate,
                              bool takes_speeds) {
  return DriveFileReader(path, joints, rate, takes_speeds).read();
}

}  // namespace robot_control
