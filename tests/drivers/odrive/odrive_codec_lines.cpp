/// The ODrive codecs as a filter of lines, for comparison with another implementation. Values stand in the order of
/// their bits, in SI units.
///
///   list VERSION                       → names
///   encode VERSION NAME NODE VALUE…    → identifier, data
///   decode VERSION NAME ID DATA        → node, values; "-" if it is another message
///   errors KIND BITS                   → names of the bits; KIND is the number of an ErrorKind
///
/// VERSION is 0.5 or 0.6. ID is decimal, DATA hexadecimal, "-" if empty.

#include <cstdio>
#include <iostream>
#include <sstream>
#include <string>

#include "drivers/odrive/odrive_catalogue.h"
#include "drivers/odrive/odrive_errors.h"

namespace robot_control::odrive {
namespace {

template <class Visit>
void visit_version(const std::string& version, Visit visit) {
  version == "0.5" ? visit_05(visit) : visit_06(visit);
}

template <class Value>
void read_value(std::istream& line, Value& value) {
  if constexpr (std::is_floating_point_v<Value>) {
    line >> value;
  } else {
    long double number = 0;  // holds all integers of 64 bits
    line >> number;
    value = number < 0 ? static_cast<Value>(static_cast<std::int64_t>(number))
                       : static_cast<Value>(static_cast<std::uint64_t>(number));
  }
}

template <class Value>
void print_value(Value value) {
  if constexpr (std::is_floating_point_v<Value>) {
    std::printf(" %.17g", value);
  } else if constexpr (std::is_signed_v<Value>) {
    std::printf(" %lld", static_cast<long long>(value));
  } else {
    std::printf(" %llu", static_cast<unsigned long long>(value));
  }
}

template <class Message>
void encode_line(std::istream& line) {
  unsigned node = 0;
  line >> node;
  Message message;
  std::apply([&](const auto&... field) { (read_value(line, message.*field.member), ...); }, Message::layout());
  const can_frame frame = encode(static_cast<std::uint8_t>(node), message);
  std::printf("%u %s", frame.can_id, frame.len == 0 ? "-" : "");
  for (std::uint8_t i = 0; i < frame.len; ++i) std::printf("%02x", frame.data[i]);
  std::printf("\n");
}

template <class Message>
void decode_line(std::istream& line) {
  can_frame frame{};
  std::string data;
  line >> frame.can_id >> data;
  for (; data != "-" && 2U * frame.len < data.size(); ++frame.len) {
    frame.data[frame.len] = static_cast<std::uint8_t>(std::stoul(data.substr(2U * frame.len, 2), nullptr, 16));
  }
  if (const auto message = decode<Message>(frame)) {
    std::printf("%u", unsigned{node_of(frame)});
    std::apply([&](const auto&... field) { (print_value((*message).*field.member), ...); }, Message::layout());
  } else {
    std::printf("-");
  }
  std::printf("\n");
}

void answer(std::istream& line) {
  std::string verb, version, name;
  line >> verb >> version;
  if (verb == "errors") {
    std::uint64_t bits = 0;
    line >> bits;
    std::printf("%s\n", error_names(static_cast<ErrorKind>(std::stoi(version)), bits).c_str());
  } else if (verb == "list") {
    visit_version(version, []<class Message>(const char* each) { std::printf("%s ", each); });
    std::printf("\n");
  } else {
    line >> name;
    visit_version(version, [&]<class Message>(const char* each) {
      if (name == each) verb == "encode" ? encode_line<Message>(line) : decode_line<Message>(line);
    });
  }
}

}  // namespace
}  // namespace robot_control::odrive

int main() {
  for (std::string text; std::getline(std::cin, text);) {
    std::istringstream line(text);
    robot_control::odrive::answer(line);
  }
}
