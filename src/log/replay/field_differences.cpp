#include "log/replay/field_differences.h"

#include <cstdint>
#include <limits>
#include <sstream>

#include "log/messages/trace_message.h"

namespace robot_control {
namespace {

template <class Number>
std::string text_of(Number number) {
  std::ostringstream text;
  text.precision(std::numeric_limits<Number>::max_digits10);
  text << number;
  return text.str();
}

/// `type` without brackets.
std::string next_text(std::string_view type, ByteSource& from) {
  if (type == "float64") return text_of(from.number<double>());
  if (type == "float32") return text_of(from.number<float>());
  if (type == "int64") return text_of(from.number<std::int64_t>());
  if (type == "uint32") return text_of(from.number<std::uint32_t>());
  if (type == "uint8") return text_of(unsigned{from.number<std::uint8_t>()});
  return text_of(from.number<std::uint64_t>());
}

/// `type` is that of the bytes, which differ.
FieldDifference difference(const std::string& name, std::string_view type, std::string_view logged,
                           std::string_view computed) {
  ByteSource was(logged), is(computed);
  if (type.ends_with("[]")) {
    const auto size = was.number<std::uint32_t>(), computed_size = is.number<std::uint32_t>();
    if (size != computed_size) return {"the length of " + name, text_of(size), text_of(computed_size)};
  }
  const std::string_view element = type.substr(0, type.find('['));
  for (std::size_t i = 0;; ++i) {
    const std::string field = type == element ? name : name + "[" + std::to_string(i) + "]";
    FieldDifference found{field, next_text(element, was), next_text(element, is)};
    // Two numbers of the same text may have other bits: a NaN, or a zero with its sign.
    if (found.logged != found.replayed || was.left() == 0) return found;
  }
}

}  // namespace

std::vector<FieldDifference> differences(const JoinedRow& logged, const JoinedRow& computed) {
  std::vector<FieldDifference> found;
  for (const TraceFields* fields : {&trace_fields(), &frame_only_fields()}) {
    for (const TraceField& field : *fields) {
      if (field.write_member == nullptr) continue;
      std::string was, is;
      field.write_member(logged, was);
      field.write_member(computed, is);
      if (was != is) found.push_back(difference(field.name, field.member_type, was, is));
    }
  }
  return found;
}

std::vector<FieldDifference> differences(std::string_view message, const TraceSource& expected) {
  std::string computed;
  encode_trace(expected, computed);
  if (message == computed) return {};
  std::vector<FieldDifference> found;
  TraceRow passed_over;
  ByteSource from(message);
  computed.clear();
  for (const TraceField& field : trace_fields()) {
    const std::size_t begin = message.size() - from.left(), computed_begin = computed.size();
    field.read(from, passed_over);
    field.write(expected, computed);
    const std::string_view logged = message.substr(begin, message.size() - from.left() - begin);
    const std::string_view again = std::string_view(computed).substr(computed_begin);
    if (logged != again) found.push_back(difference(field.name, field.type, logged, again));
  }
  return found;
}

}  // namespace robot_control
