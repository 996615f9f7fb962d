/// The codec of a Damiao motor as a filter of lines, for comparison with another implementation.
///
///   order PMAX VMAX TMAX POSITION VELOCITY STIFFNESS DAMPING TORQUE   → data
///   feedback PMAX VMAX TMAX DATA          → state, number, position, velocity, torque, two temperatures
///   register NODE OPERATION NUMBER VALUE  → data
///
/// DATA is hexadecimal, all else decimal.

#include <cstdio>
#include <iostream>
#include <sstream>
#include <string>

#include "drivers/damiao/damiao_messages.h"

namespace robot_control::damiao {
namespace {

void print(const can_frame& frame) {
  for (std::uint8_t i = 0; i < frame.len; ++i) std::printf("%02x", frame.data[i]);
  std::printf("\n");
}

MitRanges ranges_of(std::istream& line) {
  MitRanges ranges;
  line >> ranges.position >> ranges.velocity >> ranges.torque;
  return ranges;
}

void print_order(std::istream& line) {
  const MitRanges ranges = ranges_of(line);
  MitCommand command;
  line >> command.position >> command.velocity >> command.stiffness >> command.damping >> command.torque;
  print(encode_mit(1, ranges, command));
}

void print_feedback(std::istream& line) {
  const MitRanges ranges = ranges_of(line);
  std::uint64_t data = 0;
  line >> std::hex >> data;
  const Feedback feedback = decode_feedback(word_frame(17, __builtin_bswap64(data), 8), ranges);
  std::printf("%u %u %.17g %.17g %.17g %g %g\n", static_cast<unsigned>(feedback.state), feedback.node,
              feedback.position, feedback.velocity, feedback.torque, feedback.transistors, feedback.rotor);
}

void print_register(std::istream& line) {
  unsigned node = 0, operation = 0, number = 0;
  std::uint32_t value = 0;
  line >> node >> operation >> number >> value;
  print(encode(kRegisterId, RegisterAccess{.node = static_cast<std::uint16_t>(node),
                                           .operation = static_cast<Operation>(operation),
                                           .number = static_cast<Register>(number),
                                           .value = value}));
}

}  // namespace
}  // namespace robot_control::damiao

int main() {
  using namespace robot_control::damiao;
  for (std::string text; std::getline(std::cin, text);) {
    std::istringstream line(text);
    std::string word;
    line >> word;
    word == "order" ? print_order(line) : word == "feedback" ? print_feedback(line) : print_register(line);
  }
}
