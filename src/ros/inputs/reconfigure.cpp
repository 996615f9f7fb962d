#include "ros/inputs/reconfigure.h"

#include <ros/master.h>
#include <ros/param.h>

#include <algorithm>
#include <cmath>

#include "parameters/problem_list.h"

namespace robot_control {
namespace {

std::string flat_name(std::string key) {
  std::ranges::replace_if(
      key, [](char c) { return c == '.' || c == '/'; }, '_');
  return key;
}

template <class Value>
void put(dynamic_reconfigure::Config& config, const LiveParameter& parameter, const Value& value) {
  if (std::holds_alternative<bool>(parameter.value)) {
    config.bools.emplace_back();
    config.bools.back().name = flat_name(parameter.key);
    config.bools.back().value = static_cast<std::uint8_t>(value != 0);
  } else {
    config.doubles.emplace_back();
    config.doubles.back().name = flat_name(parameter.key);
    config.doubles.back().value = static_cast<double>(value);
  }
}

/// Returns a Config without values, but with the group that a client expects in every Config.
dynamic_reconfigure::Config empty_config() {
  dynamic_reconfigure::Config config;
  config.groups.emplace_back();
  config.groups.back().name = "Default";
  config.groups.back().state = 1;
  return config;
}

std::string in_quotes(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? "''" : std::string(1, c);
  return result + "'";
}

std::string yaml_number(double value) {
  if (std::isnan(value)) return ".nan";
  if (std::isinf(value)) return value < 0 ? "-.inf" : ".inf";
  return shortest(value);
}

class RequestText {
 public:
  explicit RequestText(const std::vector<LiveParameter>& parameters) : parameters_(parameters) {}

  void add(const std::string& name, const std::string& value) {
    const auto is_meant = [&name](const LiveParameter& parameter) {
      return flat_name(parameter.key) == flat_name(name);
    };
    const auto found = std::ranges::find_if(parameters_, is_meant);
    const std::string key = found == parameters_.end() ? name : found->key;
    const std::size_t dot = found == parameters_.end() ? std::string::npos : key.find('.');
    if (dot == std::string::npos) {
      append(top_, in_quotes(key), value);
    } else {
      if (!group_.empty() && group_name_ != key.substr(0, dot)) close_group();
      group_name_ = key.substr(0, dot);
      append(group_, in_quotes(key.substr(dot + 1)), value);
    }
  }

  std::string text() {
    close_group();
    return top_.empty() ? "" : "{" + top_ + "}";
  }

 private:
  static void append(std::string& text, const std::string& key, const std::string& value) {
    text += (text.empty() ? "" : ", ") + key + ": " + value;
  }

  void close_group() {
    if (!group_.empty()) append(top_, in_quotes(group_name_), "{" + group_ + "}");
    group_.clear();
  }

  const std::vector<LiveParameter>& parameters_;
  std::string top_;
  std::string group_name_;
  std::string group_;
};

}  // namespace

dynamic_reconfigure::Config config_of(const std::vector<LiveParameter>& parameters) {
  dynamic_reconfigure::Config config = empty_config();
  for (const LiveParameter& parameter : parameters) {
    std::visit([&](auto value) { put(config, parameter, value); }, parameter.value);
  }
  return config;
}

dynamic_reconfigure::ConfigDescription description_of(const std::vector<LiveParameter>& parameters) {
  dynamic_reconfigure::ConfigDescription description;
  description.groups.emplace_back();
  dynamic_reconfigure::Group& group = description.groups.back();
  group.name = "Default";
  description.min = empty_config();
  description.max = empty_config();
  for (const LiveParameter& parameter : parameters) {
    const bool is_bool = std::holds_alternative<bool>(parameter.value);
    group.parameters.emplace_back();
    dynamic_reconfigure::ParamDescription& entry = group.parameters.back();
    entry.name = flat_name(parameter.key);
    entry.type = is_bool ? "bool" : "double";
    entry.description = parameter.rule;
    put(description.min, parameter, is_bool ? 0 : parameter.min);
    put(description.max, parameter, is_bool ? 1 : parameter.max);
  }
  description.dflt = config_of(parameters);
  return description;
}

std::string request_text(const dynamic_reconfigure::Config& request, const std::vector<LiveParameter>& parameters) {
  RequestText text(parameters);
  for (const auto& entry : request.bools) text.add(entry.name, entry.value != 0 ? "true" : "false");
  for (const auto& entry : request.ints) text.add(entry.name, std::to_string(entry.value));
  for (const auto& entry : request.doubles) text.add(entry.name, yaml_number(entry.value));
  for (const auto& entry : request.strs) text.add(entry.name, in_quotes(entry.value));
  return text.text();
}

std::string write_overrides(const std::vector<LiveValue>& values) {
  std::string unwritten;
  for (const LiveValue& value : values) {
    // Without a master ros::param::set would wait for ever. After one failure the remaining values are not tried.
    if (!unwritten.empty() || !ros::master::check()) {
      unwritten += (unwritten.empty() ? "" : ", ") + value.key;
      continue;
    }
    std::string name = "~" + value.key;
    std::ranges::replace(name, '.', '/');
    std::visit([&name](auto plain) { ros::param::set(name, plain); }, value.value);
  }
  if (unwritten.empty()) return "";
  return "the parameter server does not know " + unwritten + ": no ROS master answers";
}

}  // namespace robot_control
