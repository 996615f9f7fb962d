#include "log/replay/message_differences.h"

#include <cstdint>
#include <limits>
#include <sstream>
#include <string>

#include "log/messages/trace_message.h"

namespace robot_control {
namespace {

/// A field's bytes, element by element.
class Elements {
 public:
  Elements(std::string_view type, std::string_view bytes)
      : type_(type.substr(0, type.find('['))), array_(type.size() > type_.size()), source_(bytes) {
    if (type.ends_with("[]")) size_ = source_.number<std::uint32_t>();
  }

  bool array() const noexcept { return array_; }
  std::uint32_t size() const noexcept { return size_; }  ///< of a list; else 0
  bool left() const noexcept { return source_.left() != 0; }

  std::string next() {
    if (type_ == "float64") return text(source_.number<double>());
    if (type_ == "float32") return text(source_.number<float>());
    if (type_ == "int64") return text(source_.number<std::int64_t>());
    if (type_ == "uint32") return text(source_.number<std::uint32_t>());
    if (type_ == "uint8") return text(unsigned{source_.number<std::uint8_t>()});
    return text(source_.number<std::uint64_t>());
  }

 private:
  template <class Number>
  static std::string text(Number number) {
    std::ostringstream text;
    text.precision(std::numeric_limits<Number>::max_digits10);
    text << number;
    return text.str();
  }

  std::string_view type_;
  bool array_;
  ByteSource source_;
  std::uint32_t size_ = 0;
};

FieldDifference difference(const TraceField& field, std::string_view logged, std::string_view computed) {
  Elements was(field.type, logged), is(field.type, computed);
  if (was.size() != is.size()) {
    return {"the length of " + field.name, std::to_string(was.size()), std::to_string(is.size())};
  }
  FieldDifference found{field.name, was.next(), is.next()};
  // Two numbers of the same text may have other bits: a NaN, or a zero with its sign.
  for (std::size_t i = 1; found.logged == found.replayed && was.left(); ++i) {
    found = {field.name + "[" + std::to_string(i) + "]", was.next(), is.next()};
  }
  if (is.array() && found.field == field.name) found.field += "[0]";
  return found;
}

}  // namespace

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
    if (logged != again) found.push_back(difference(field, logged, again));
  }
  return found;
}

}  // namespace robot_control
