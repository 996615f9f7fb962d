#include "log/messages/log_messages.h"

#include <algorithm>
#include <cstring>
#include <sstream>

#include "log/fields/trace_fields.h"
#include "log/messages/message_checksum.h"
#include "log/messages/trace_message.h"
#include "log/packed_chunk.h"
#include "signals/formatted_text.h"

namespace robot_control {
namespace {

class Writer {
 public:
  void operator()(const std::string& value) { sink_.text(value); }
  void operator()(const std::vector<std::string>& values) {
    sink_.number(static_cast<std::uint32_t>(values.size()));
    for (const std::string& value : values) sink_.text(value);
  }
  template <class Number>
  void operator()(const std::vector<Number>& values) {
    sink_.number(static_cast<std::uint32_t>(values.size()));
    for (const Number value : values) sink_.number(value);
  }
  template <class Number>
  void operator()(const Number& value) {
    sink_.number(value);
  }

  std::string bytes;

 private:
  ByteSink sink_{bytes};
};

class Reader {
 public:
  explicit Reader(std::string_view message) : source_(message) {}

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

/// Visits the fields in the order of the .msg.
template <class Header, class Visit>
void each_header_field(Header& header, Visit visit) {
  visit("robot", header.robot);
  visit("kind", header.kind);
  visit("joints", header.joints);
  visit("roles", header.roles);
  visit("contacts", header.contacts);
  visit("wheels", header.wheels);
  visit("period", header.period);
  visit("clock", header.clock);
  visit("record", header.record);
  visit("part", header.part);
  visit("parameters", header.parameters);
  visit("urdf", header.urdf);
  visit("scene", header.scene);
  visit("calibration", header.calibration);
  visit("version", header.version);
  visit("build", header.build);
  visit("host", header.host);
  visit("kernel", header.kernel);
  visit("processor", header.processor);
  visit("libraries", header.libraries);
  visit("missing", header.missing);
  visit("checksum", header.checksum);
}

constexpr std::size_t kChecksumDigits = 8;

std::string checksum_text(std::string_view bytes) {
  return formatted("%08x", message_checksum(bytes, 0));
}

/// These functions name the type of a member in a .msg.
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

/// Ignores a field that another version has.
void pass_over(Reader& read, const std::string& type, const std::string& name) {
  const auto drop = [&](auto value) { read(value); };
  if (type == "string") return drop(std::string());
  if (type == "string[]") return drop(std::vector<std::string>());
  if (type == "uint32") return drop(std::uint32_t{});
  if (type == "float64") return drop(double{});
  throw TraceError("field " + name + " of TraceHeader has the type " + type + ", which is not read");
}

template <class Snapshot, class Visit>
void each_snapshot_number(Snapshot& snapshot, Visit& visit) {
  visit(snapshot.head.run);
  visit(snapshot.head.cycle);
  visit(snapshot.head.stamp_ns);
  visit(snapshot.head.checksum);
  visit(snapshot.build);
  visit(snapshot.process);
  visit(snapshot.number);
}

}  // namespace

std::string encode(const LogHeader& header) {
  Writer write;
  each_header_field(header, [&](std::string_view name, const auto& member) {
    name == "checksum" ? write(checksum_text(write.bytes)) : write(member);
  });
  return write.bytes;
}

std::string encode(const TraceSummary& summary) {
  Writer write;
  write(summary.stamp_ns);
  write(summary.names);
  write(summary.samples);
  write(summary.min);
  write(summary.p50);
  write(summary.p99);
  write(summary.p999);
  write(summary.max);
  write(summary.counters);
  write(summary.counts);
  return write.bytes;
}

bool intact(const LogHeader& header) {
  const std::string sealed = encode(header);
  return sealed.substr(sealed.size() - kChecksumDigits) == header.checksum;
}

std::string encode(const LawSnapshot& snapshot) {
  Writer write;
  write(std::string(kLawNames.at(static_cast<std::size_t>(snapshot.law))));
  each_snapshot_number(snapshot, write);
  write(std::string(reinterpret_cast<const char*>(snapshot.state.data()), snapshot.bytes));
  return write.bytes;
}

LogHeader decode_header(std::string_view message, const std::string& definition) {
  LogHeader header;
  Reader read(message);
  std::istringstream lines(definition);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line.substr(0, line.find('#')));
    std::string type, name;
    if (!(words >> type >> name)) continue;
    bool known = false;
    each_header_field(header, [&](std::string_view field, auto& member) {
      if (field != name || type_of(member) != type) return;
      read(member);
      known = true;
    });
    if (!known) pass_over(read, type, name);
  }
  if (!read.whole()) throw TraceError("the message TraceHeader has not the length of its fields");
  const double rate = 1 / header.period;  // Hz; robot.rate is 20 … 2000
  if (!(rate >= 1 && rate <= 1e5)) throw TraceError("the period of TraceHeader is of no loop");
  return header;
}

LawSnapshot decode_snapshot(std::string_view message) {
  LawSnapshot snapshot;
  std::string node, state;
  Reader read(message);
  read(node);
  each_snapshot_number(snapshot, read);
  read(state);
  const auto* const law = std::find(kLawNames.begin(), kLawNames.end(), node);
  if (!read.whole() || law == kLawNames.end() || state.size() > kSnapshotBytes) {
    throw TraceError("a message Snapshot has not the length of its fields, or is of no known node");
  }
  snapshot.law = static_cast<LawName>(law - kLawNames.begin());
  snapshot.bytes = state.size();
  std::memcpy(snapshot.state.data(), state.data(), state.size());
  return snapshot;
}

}  // namespace robot_control
