#include "parameters/parameters_text.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "parameters/problem_list.h"
#include "parameters/schema/schema.h"

namespace robot_control {
namespace {

/// Returns the value in YAML; empty if there is none.
class ValueText {
 public:
  explicit ValueText(const Field& field) : field_(field) {}

  std::string operator()(const double* value) const { return yaml_number(*value); }
  std::string operator()(const std::optional<double>* value) const { return *value ? yaml_number(**value) : ""; }
  template <std::size_t N>
  std::string operator()(const std::array<double, N>* value) const {
    std::string text;
    for (const double number : *value) text += (text.empty() ? "" : ", ") + yaml_number(number);
    return "[" + text + "]";
  }
  template <std::size_t N>
  std::string operator()(const std::optional<std::array<double, N>>* value) const {
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
  template <class Enum>
  std::string operator()(const Enum* value) const {
    const auto words = words_of(field_);
    const auto word = std::find_if(words.begin(), words.end(),
                                   [&](const Word& each) { return each.value == static_cast<int>(*value); });
    return std::string(word->text);
  }

 private:
  const Field& field_;
};

bool left_out(const Key& key, const std::string& text) {
  return text.empty() || !key.other_name_of.empty() || ((key.traits & kOptional) != 0 && text == "\"\"");
}

}  // namespace

std::string parameters_text(Parameters parameters) {
  std::string text;
  for (const Block& block : schema()) {
    text.append(block.name).append(":\n");
    std::string group;
    for (const Key& key : block.keys) {
      const Field field = key.field(parameters);
      const std::string value = std::visit(ValueText(field), field);
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
