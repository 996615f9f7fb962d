/// The codecs of motors in MIT mode as a filter of lines, for comparison with other implementations.
///
///   damiao order RANGES POSITION VELOCITY STIFFNESS DAMPING TORQUE     → identifier, data
///   ak order, cybergear order                                          the same
///   damiao feedback RANGES ID DATA     → state, number, position, velocity, torque, two temperatures
///   ak feedback RANGES ID DATA         → number, position, velocity, torque
///   cybergear feedback RANGES ID DATA  → mode, faults, number, position, velocity, torque, temperature
///   damiao access NODE OPERATION NUMBER VALUE  → identifier, data
///   cybergear access NODE TYPE INDEX VALUE     → identifier, data
///   moteus order NODE DETAILS POSITION VELOCITY STIFFNESS DAMPING TORQUE TIMEOUT KP KD MAX_TORQUE  → identifier, data
///   moteus stop NODE DETAILS  → identifier, data
///   moteus feedback NODE ID DATA  → the numbers of moteus::Reply, in their order; - if the frame is none
///
/// The orders without NODE are for motor 1. KP and KD are those of the scale 1, in N·m/rad and N·m·s/rad. RANGES are
/// those of position, velocity and torque. DATA is hexadecimal, all else decimal.

#include <cstdio>
#include <iostream>
#include <sstream>
#include <string>

#include "drivers/ak/ak_messages.h"
#include "drivers/cybergear/cybergear_messages.h"
#include "drivers/damiao/damiao_messages.h"
#include "drivers/moteus/moteus_messages.h"

namespace robot_control {
namespace {

void print(const can_frame& frame) {
  std::printf("%u ", frame.can_id & CAN_EFF_MASK);
  for (std::uint8_t i = 0; i < frame.len; ++i) std::printf("%02x", frame.data[i]);
  std::printf("\n");
}

MitRanges ranges_of(std::istream& line) {
  MitRanges ranges;
  line >> ranges.position >> ranges.velocity >> ranges.torque;
  return ranges;
}

void print_order(std::istream& line, bool is_cybergear) {
  const MitRanges ranges = ranges_of(line);
  MitCommand command;
  line >> command.position >> command.velocity >> command.stiffness >> command.damping >> command.torque;
  print(is_cybergear ? cybergear::encode_order(1, ranges, command) : encode_mit(1, ranges, command));
}

void print_feedback(std::istream& line, const std::string& dialect) {
  const MitRanges ranges = ranges_of(line);
  canid_t id = 0;
  std::string data;
  line >> id >> data;
  const auto bytes = static_cast<std::uint8_t>(data.size() / 2);
  const std::uint64_t word = std::stoull(data, nullptr, 16) << (64U - 8U * bytes);
  const can_frame frame = word_frame(id, __builtin_bswap64(word), bytes);
  if (dialect == "damiao") {
    const auto read = damiao::decode_feedback(frame, ranges);
    std::printf("%u %u %.17g %.17g %.17g %g %g\n", static_cast<unsigned>(read.state), read.node, read.position,
                read.velocity, read.torque, read.transistors, read.rotor);
  } else if (dialect == "ak") {
    const auto read = ak::decode_reply(frame, ranges).value_or(ak::Reply{});
    std::printf("%u %.17g %.17g %.17g\n", read.node, read.position, read.velocity, read.torque);
  } else {
    const auto read = cybergear::decode_feedback(frame, ranges);
    std::printf("%u %u %u %.17g %.17g %.17g %.17g\n", static_cast<unsigned>(read.mode), read.faults, read.node,
                read.position, read.velocity, read.torque, read.temperature);
  }
}

void print_access(std::istream& line, bool is_cybergear) {
  unsigned node = 0, kind = 0, number = 0;
  std::uint32_t value = 0;
  line >> node >> kind >> number >> value;
  if (is_cybergear) {
    print(cybergear::encode({.type = static_cast<cybergear::Type>(kind),
                             .data = cybergear::kHost,
                             .target = static_cast<std::uint8_t>(node)},
                            {.index = static_cast<cybergear::Parameter>(number), .value = value}));
  } else {
    print(damiao::encode(damiao::kRegisterId, damiao::RegisterAccess{.node = static_cast<std::uint16_t>(node),
                                                                     .operation = static_cast<damiao::Operation>(kind),
                                                                     .number = static_cast<damiao::Register>(number),
                                                                     .value = value}));
  }
}

can_frame moteus_request(std::istream& line, bool stops) {
  std::uint64_t node = 0;
  moteus::Request request;
  MitRanges gains;
  MitCommand& command = request.command;
  line >> node >> request.details;
  if (stops) return moteus::encode(node, gains, request);
  request.mode = moteus::Mode::kPosition;
  line >> command.position >> command.velocity >> command.stiffness >> command.damping >> command.torque;
  line >> request.timeout >> gains.stiffness >> gains.damping >> request.max_torque;
  return moteus::encode(node, gains, request);
}

void print_moteus_reply(std::istream& line) {
  std::uint64_t node = 0;
  can_frame frame{};
  std::string data;
  line >> node >> frame.can_id >> data;
  frame.flags = CANFD_FDF;
  frame.len = static_cast<std::uint8_t>(data.size() / 2);
  for (std::size_t i = 0; i < frame.len; ++i)
    frame.data[i] = static_cast<std::uint8_t>(std::stoul(data.substr(2 * i, 2), nullptr, 16));
  const auto reply = moteus::decode_reply(frame, node);
  if (!reply) return static_cast<void>(std::printf("-\n"));
  for (const double number :
       {reply->mode, reply->position, reply->velocity, reply->torque, reply->voltage, reply->temperature, reply->fault,
        reply->home, reply->map_version, reply->proportional, reply->integral, reply->derivative})
    std::printf("%.17g ", number);
  std::printf("\n");
}

}  // namespace
}  // namespace robot_control

int main() {
  using namespace robot_control;
  for (std::string text; std::getline(std::cin, text);) {
    std::istringstream line(text);
    std::string dialect, word;
    line >> dialect >> word;
    if (dialect == "moteus" && word == "feedback") {
      print_moteus_reply(line);
    } else if (dialect == "moteus") {
      print(moteus_request(line, word == "stop"));
    } else if (word == "order") {
      print_order(line, dialect == "cybergear");
    } else if (word == "feedback") {
      print_feedback(line, dialect);
    } else {
      print_access(line, dialect == "cybergear");
    }
  }
}
