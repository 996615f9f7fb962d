#include "log/messages/trace_message.h"

#include <algorithm>
#include <charconv>
#include <map>
#include <sstream>

namespace robot_control {
namespace {

/// The size of a type of ROS's own in bytes; 0: it is another type.
std::size_t size_of(std::string_view type) {
  static const std::map<std::string_view, std::size_t> sizes{
      {"bool", 1},    {"int8", 1},  {"uint8", 1},    {"byte", 1},    {"char", 1},  {"int16", 2},
      {"uint16", 2},  {"int32", 4}, {"uint32", 4},   {"float32", 4}, {"int64", 8}, {"uint64", 8},
      {"float64", 8}, {"time", 8},  {"duration", 8}, {"string", 1}};
  const auto found = sizes.find(type);
  return found == sizes.end() ? 0 : found->second;
}

constexpr std::size_t kMaxDefinition = 1 << 18;  // bytes
constexpr std::size_t kMaxArray = 1 << 12;       // elements

}  // namespace

void encode_trace(const TraceSource& source, std::string& to) {
  to.clear();
  for (const TraceField& field : trace_fields()) field.write(source, to);
}

TraceDecoder::TraceDecoder(const std::string& definition) {
  if (definition.size() > kMaxDefinition) throw TraceError("the definition of Trace is too long");
  std::istringstream lines(definition);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("===")) break;  // the definitions of other messages follow
    std::istringstream words(line.substr(0, line.find('#')));
    std::string type, name;
    if (!(words >> type >> name)) continue;
    if (name.find('=') != std::string::npos || (words >> std::ws).peek() == '=') continue;  // a constant
    Step step;
    step.name = name;
    const std::size_t bracket = type.find('[');
    step.element = size_of(std::string_view(type).substr(0, bracket));
    if (type.starts_with("string") && bracket != std::string::npos) step.element = 0;
    if (step.element == 0) throw TraceError("field " + name + " of Trace has the type " + type + ", which is not read");
    if (type == "string" || type.ends_with("[]")) {
      step.count = 0;
    } else if (bracket != std::string::npos) {
      const char* const end = type.data() + type.size();
      const auto [stop, error] = std::from_chars(type.data() + bracket + 1, end, step.count);
      if (error != std::errc() || *stop != ']' || step.count == 0 || step.count > kMaxArray) {
        throw TraceError("field " + name + " of Trace has the type " + type + ", which is not read");
      }
    }
    const auto& fields = trace_fields();
    const auto same = std::find_if(fields.begin(), fields.end(),
                                   [&](const TraceField& field) { return field.name == name && field.type == type; });
    if (same != fields.end()) step.field = &*same;
    steps_.push_back(std::move(step));
  }
  for (const TraceField& field : trace_fields()) {
    if (std::none_of(steps_.begin(), steps_.end(), [&](const Step& step) { return step.field == &field; })) {
      missing_.push_back(field.name);
    }
  }
}

bool TraceDecoder::of_this_version() const {
  return std::ranges::equal(steps_, trace_fields(),
                            [](const Step& step, const TraceField& field) { return step.field == &field; });
}

void TraceDecoder::decode(std::string_view message, TraceRow& row) const {
  row = {};
  ByteSource from(message);
  for (const Step& step : steps_) {
    bool fits = true;
    if (step.field != nullptr) {
      fits = step.field->read(from, row);
    } else {
      const std::size_t count = step.count == 0 ? from.number<std::uint32_t>() : step.count;
      from.bytes(count * step.element);
    }
    if (!fits) throw TraceError("field " + step.name + " of Trace has more elements than there is room for");
    if (!from.ok()) throw TraceError("a message Trace ends within its field " + step.name);
  }
  if (from.left() != 0) throw TraceError("a message Trace has " + std::to_string(from.left()) + " bytes too many");
  const int answered = row.repeats ? row.parts : row.published;
  const auto set_head = [&](FrameHead& head, TracePart part) {
    head.run = row.run_id;
    head.cycle = row.cycle;
    head.stamp_ns = row.stamp_ns;
    head.kind = (answered & part) != 0 ? FrameKind::kFrame : FrameKind::kToken;
  };
  set_head(row.driver.sensors.head, kPartDriver);
  set_head(row.driver.truth.head, kPartDriver);
  set_head(row.estimator.state.head, kPartEstimator);
  set_head(row.controller.command.head, kPartController);
  set_head(row.monitor.permit.head, kPartMonitor);
}

}  // namespace robot_control
