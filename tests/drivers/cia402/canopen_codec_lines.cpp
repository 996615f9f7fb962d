/// The CANopen codecs as a filter of lines, for exchanges with another implementation. Each line is answered at once.
///
///   nmt COMMAND NODE · sync                              → frame
///   upload NODE INDEX SUB                                → frame
///   download NODE INDEX SUB VALUE BYTES                  → frame, expedited
///   begin NODE INDEX SUB SIZE                            → frame of a download in segments
///   get NODE TOGGLE · put NODE TOGGLE LAST DATA          → frame of a segment
///   response NODE ID DATA                                → command expedited toggle last size data abort-words
///   heartbeat ID DATA                                    → node state
///   emergency ID DATA                                    → node code register maker's-data
///   setup PDO NODE                                       → index sub value bytes; for each write; PDO: command, state
///   command NODE CONTROLWORD TORQUE                      → frame of the RPDO
///   state NODE ID DATA                                   → statusword position torque
///
/// A frame is "ID DATA". All numbers are decimal, DATA is hexadecimal, "-" if empty.

#include <cstdio>
#include <iostream>
#include <sstream>
#include <string>

#include "drivers/cia402/drive_objects.h"
#include "drivers/cia402/sdo.h"

namespace robot_control::canopen {
namespace {

void print_bytes(const std::uint8_t* bytes, std::size_t count) {
  std::printf(" %s", count == 0 ? "-" : "");
  for (std::size_t i = 0; i < count; ++i) std::printf("%02x", bytes[i]);
}

void print(const can_frame& frame) {
  std::printf("%u", frame.can_id);
  print_bytes(frame.data, frame.len);
}

std::uint8_t byte_from(std::istream& line) {
  unsigned number = 0;
  line >> number;
  return static_cast<std::uint8_t>(number);
}

ObjectAddress object_from(std::istream& line) {
  ObjectAddress object;
  line >> object.index;
  object.sub = byte_from(line);
  return object;
}

can_frame frame_from(std::istream& line) {
  can_frame frame{};
  std::string data;
  line >> frame.can_id >> data;
  for (; data != "-" && 2U * frame.len < data.size(); ++frame.len) {
    frame.data[frame.len] = static_cast<std::uint8_t>(std::stoul(data.substr(2U * frame.len, 2), nullptr, 16));
  }
  return frame;
}

void print_response(std::uint8_t node, const can_frame& frame) {
  const auto message = decode_sdo(SdoSide::kResponse, node, frame);
  if (!message) return;
  std::printf("%u %d %d %d %u", static_cast<unsigned>(message->command), message->expedited, message->toggle,
              message->last, message->size);
  print_bytes(message->data.data(), message->length);
  std::printf(" %s", message->command == SdoCommand::kAbort ? abort_words(message->abort_code) : "");
}

void print_emergency(const can_frame& frame) {
  const auto emergency = decode_emergency(frame);
  if (!emergency) return;
  std::printf("%u %u %u", emergency->node, emergency->code, emergency->error_register);
  print_bytes(emergency->specific.data(), emergency->specific.size());
}

void print_setup(const std::string& kind, std::uint8_t node) {
  const cia402::AxisPdos pdos;
  const Pdo& pdo = kind == "command" ? pdos.command : kind == "state" ? pdos.state : pdos.velocity;
  for (const SdoWrite& write : pdo_setup(pdo, node, kEverySync, 0).all()) {
    std::printf("%u %u %u %u;", write.object.index, write.object.sub, write.value, write.bytes);
  }
}

/// Answers the verbs whose answer is one SDO request.
bool answer_request(const std::string& verb, std::istream& line) {
  SdoMessage message;
  const std::uint8_t node = byte_from(line);
  if (verb == "upload") {
    message.object = object_from(line);
  } else if (verb == "download") {
    const ObjectAddress object = object_from(line);
    std::uint32_t value = 0;
    line >> value;
    message = expedited_download(object, value, byte_from(line));
  } else if (verb == "begin") {
    message = {.command = SdoCommand::kDownload, .object = object_from(line)};
    line >> message.size;
  } else if (verb == "get") {
    message = {.command = SdoCommand::kUploadSegment, .toggle = byte_from(line) != 0};
  } else if (verb == "put") {
    message = {.command = SdoCommand::kDownloadSegment, .toggle = byte_from(line) != 0, .last = byte_from(line) != 0};
    std::istringstream data("0 " + std::string(std::istreambuf_iterator<char>(line), {}));
    const can_frame bytes = frame_from(data);
    message.length = bytes.len;
    std::copy_n(bytes.data, bytes.len, message.data.begin());
  } else {
    return false;
  }
  print(encode_sdo(SdoSide::kRequest, node, message));
  return true;
}

void answer_other(const std::string& verb, std::istream& line) {
  const cia402::AxisPdos pdos;
  if (verb == "nmt") {
    const NmtCommand command{byte_from(line)};
    print(encode_nmt({.command = command, .node = byte_from(line)}));
  } else if (verb == "sync") {
    print(sync_frame());
  } else if (verb == "response") {
    const std::uint8_t node = byte_from(line);
    print_response(node, frame_from(line));
  } else if (verb == "heartbeat") {
    if (const auto heartbeat = decode_heartbeat(frame_from(line))) {
      std::printf("%u %u", heartbeat->node, static_cast<unsigned>(heartbeat->state));
    }
  } else if (verb == "emergency") {
    print_emergency(frame_from(line));
  } else if (verb == "setup") {
    std::string kind;
    line >> kind;
    print_setup(kind, byte_from(line));
  } else if (verb == "command") {
    const std::uint8_t node = byte_from(line);
    std::int64_t values[2] = {};
    line >> values[0] >> values[1];
    print(encode_pdo(pdos.command, node, values));
  } else if (verb == "state") {
    const std::uint8_t node = byte_from(line);
    std::int64_t values[3] = {};
    if (!decode_pdo(pdos.state, node, frame_from(line), values)) return;
    std::printf("%lld %lld %lld", static_cast<long long>(values[0]), static_cast<long long>(values[1]),
                static_cast<long long>(values[2]));
  }
}

}  // namespace
}  // namespace robot_control::canopen

int main() {
  for (std::string text; std::getline(std::cin, text);) {
    std::istringstream line(text), again(text);
    std::string verb;
    line >> verb;
    again >> verb;
    if (!robot_control::canopen::answer_request(verb, line)) robot_control::canopen::answer_other(verb, again);
    std::printf("\n");
    std::fflush(stdout);
  }
}
