#include "recording/log_messages.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <sstream>

#include "recording/fields/trace_fields.h"
#include "recording/message_checksum.h"
#include "recording/packed_chunk.h"
#include "recording/trace_message.h"

namespace robot_control {
namespace {

class Put {
 public:
  void operator()(const std::string& value) { sink_.text(value); }
  void operator()(const std::vector<std::string>& values) {
    sink_.number(static_cast<std::uint32_t>(values.size()));
    for (const std::string& value : values) sink_.text(value);
  }
  template <class Number>
  void operator()(const Number& value) {
    sink_.number(value);
  }

  std::string bytes;

 private:
  ByteSink sink_{bytes};
};

class Take {
 public:
  explicit Take(std::string_view message) : source_(message) {}

  void operator()(std::string& value) { value = source_.text(); }
  void operator()(std::vector<std::string>& values) {
    const auto count = source_.number<std::uint32_t>();
    for (std::uint32_t i = 0; i < count && source_.ok(); ++i) values.emplace_back(source_.text());
  }
  template <class Number>
  void operator()(Number& value) {
    value = source_.number<Number>();
  }

  bool whole() const { return source_.ok() && source_.left() == 0; }

 private:
  ByteSource source_;
};

/// The fields in the order of the .msg.
template <class Header, class Visit>
void each_header_field(Header& of, Visit visit) {
  visit("robot", of.robot);
  visit("joints", of.joints);
  visit("wheels", of.wheels);
  visit("period", of.period);
  visit("clock", of.clock);
  visit("record", of.record);
  visit("part", of.part);
  visit("parameters", of.parameters);
  visit("urdf", of.urdf);
  visit("scene", of.scene);
  visit("calibration", of.calibration);
  visit("version", of.version);
  visit("build", of.build);
  visit("host", of.host);
  visit("kernel", of.kernel);
  visit("processor", of.processor);
  visit("libraries", of.libraries);
  visit("missing", of.missing);
  visit("checksum", of.checksum);
}

constexpr std::size_t kChecksumDigits = 8;

std::string checksum_text(std::string_view bytes) {
  std::array<char, kChecksumDigits + 1> text{};
  std::snprintf(text.data(), text.size(), "%08x", message_checksum(bytes, 0));
  return text.data();
}

/// Of a member in a .msg.
std::string_view type_of(const std::string&) {
  return "string";
}
std::string_view type_of(const std::vector<std::string>&) {
  return "string[]";
}
std::string_view type_of(std::uint32_t) {
  return "uint32";
}
std::string_view type_of(double) {
  return "float64";
}

/// Of a version that has a field which this one has not.
void pass_over(Take& take, const std::string& type, const std::string& name) {
  const auto drop = [&](auto value) { take(value); };
  if (type == "string") return drop(std::string());
  if (type == "string[]") return drop(std::vector<std::string>());
  if (type == "uint32") return drop(std::uint32_t{});
  if (type == "float64") return drop(double{});
  throw TraceError("field " + name + " of TraceHeader has the type " + type + ", which is not read");
}

template <class Snapshot, class Visit>
void each_snapshot_number(Snapshot& of, Visit& visit) {
  visit(of.head.run);
  visit(of.head.cycle);
  visit(of.head.stamp_ns);
  visit(of.head.checksum);
  visit(of.build);
  visit(of.process);
  visit(of.number);
}

}  // namespace

std::string encode(const LogHeader& header) {
  Put put;
  each_header_field(header, [&](std::string_view name, const auto& member) {
    name == "checksum" ? put(checksum_text(put.bytes)) : put(member);
  });
  return put.bytes;
}

bool intact(const LogHeader& header) {
  const std::string sealed = encode(header);
  return sealed.substr(sealed.size() - kChecksumDigits) == header.checksum;
}

std::string encode(const LawSnapshot& snapshot) {
  Put put;
  put(std::string(kLawNodes.at(static_cast<std::size_t>(snapshot.law))));
  each_snapshot_number(snapshot, put);
  put(std::string(reinterpret_cast<const char*>(snapshot.state.data()), snapshot.bytes));
  return put.bytes;
}

LogHeader decode_header(std::string_view message, const std::string& definition) {
  LogHeader header;
  Take take(message);
  std::istringstream lines(definition);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line.substr(0, line.find('#')));
    std::string type, name;
    if (!(words >> type >> name)) continue;
    bool known = false;
    each_header_field(header, [&](std::string_view field, auto& member) {
      if (field != name || type_of(member) != type) return;
      take(member);
      known = true;
    });
    if (!known) pass_over(take, type, name);
  }
  if (!take.whole()) throw TraceError("the message TraceHeader has not the length of its fields");
  return header;
}

LawSnapshot decode_snapshot(std::string_view message) {
  LawSnapshot snapshot;
  std::string node, state;
  Take take(message);
  take(node);
  each_snapshot_number(snapshot, take);
  take(state);
  const auto* const law = std::find(kLawNodes.begin(), kLawNodes.end(), node);
  if (!take.whole() || law == kLawNodes.end() || state.size() > kSnapshotBytes) {
    throw TraceError("a message Snapshot has not the length of its fields, or is of no known node");
  }
  snapshot.law = static_cast<LawName>(law - kLawNodes.begin());
  snapshot.bytes = state.size();
  std::memcpy(snapshot.state.data(), state.data(), state.size());
  return snapshot;
}

}  // namespace robot_control
