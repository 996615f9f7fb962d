#include "parameters/parameters_text.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace robot_control {
namespace {

struct ValueText {
  std::string operator()(const double* value) const { return yaml_number(*value); }
  template <std::size_t N>
  std::string operator()(const std::array<double, N>* value) const {
    std::string text;
    for (const double number : *value) text += (text.empty() ? "" : ", ") + yaml_number(number);
    return "[" + text + "]";
  }
  template <class Value>
  std::string operator()(const std::optional<Value>* value) const {
    return *value ? (*this)(&**value) : "";
  }
  std::string operator()(const std::int64_t* value) const { return std::to_string(*value); }
  std::string operator()(const std::uint64_t* value) const { return std::to_string(*value); }
  std::string operator()(const bool* value) const { return *value ? "true" : "false"; }
  std::string operator()(const std::string* value) const { return yaml_quoted(*value); }
  std::string operator()(const std::vector<std::string>* value) const {
    std::string text;
    for (const std::string& name : *value) text += (text.empty() ? "" : ", ") + yaml_quoted(name);
    return "[" + text + "]";
  }
  std::string operator()(const Choice& choice) const {
    const int value = choice.get(choice.place);
    return std::string(std::ranges::find(choice.words, value, &Word::value)->text);
  }
};

bool left_out(const Key& key, const std::string& text) {
  return text.empty() || !key.other_name_of.empty() || ((key.traits & kOptional) != 0 && text == "\"\"");
}

}  // namespace

std::string value_text(const Field& field) {
  return std::visit(ValueText{}, field);
}

std::string blocks_text(std::span<const Block> blocks) {
  std::string text;
  for (const Block& block : blocks) {
    text.append(block.name).append(":\n");
    std::string group;
    for (const Key& key : block.keys) {
      const std::string value = value_text(key.field);
      if (left_out(key, value)) continue;
      if (key.group != group && !key.group.empty()) text.append("  ").append(key.group).append(":\n");
      group = key.group;
      text.append(group.empty() ? "  " : "    ").append(key.name).append(": ").append(value).append("\n");
    }
  }
  return text;
}

std::string yaml_number(double value) {
  if (std::isnan(value)) return ".nan";
  if (std::isinf(value)) return value > 0 ? ".inf" : "-.inf";
  return shortest(value);
}

std::string yaml_quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    if (c == '\n') {
      result += "\\n";
    } else {
      result += c;
    }
  }
  return result + "\"";
}

}  // namespace robot_control
