#include "parameters/schema.h"

namespace robot_control {
namespace {

std::string range_of(const Key& key, std::string_view noun) {
  std::string rule = (key.traits & kZeroIsOff) != 0 && key.min > 0 ? "0 (off) or " : "";
  rule += std::string(noun) + " of " + shortest(key.min) + " … " + shortest(key.max);
  if (!key.unit.empty()) rule.append(" ").append(key.unit);
  if ((key.traits & kZeroIsOff) != 0 && key.min <= 0) rule += " (0 = off)";
  return rule;
}

struct Rule {
  std::string operator()(const double*) const { return range_of(key, "a number"); }
  std::string operator()(const std::int64_t*) const { return range_of(key, "a whole number"); }
  std::string operator()(const std::uint64_t*) const { return range_of(key, "a whole number"); }
  std::string operator()(const NumberList<3>*) const { return range_of(key, "a list of three numbers, each"); }
  std::string operator()(const NumberList<4>*) const { return range_of(key, "a list of four numbers, each"); }
  std::string operator()(const NumberList<6>*) const { return range_of(key, "a list of six numbers, each"); }
  template <class Value>
  std::string operator()(const std::optional<Value>*) const {
    return (*this)(static_cast<const Value*>(nullptr));
  }
  std::string operator()(const bool*) const { return "true or false"; }
  std::string operator()(const std::string*) const {
    const std::string noun = (key.traits & kPath) != 0 ? "a path" : "a text";
    return (key.traits & kMayBeEmpty) != 0 ? noun + ", \"\" = none" : noun + ", not empty";
  }
  std::string operator()(const std::vector<std::string>*) const {
    return "a name or a list of names, [] = found in the URDF";
  }
  std::string operator()(const Choice& choice) const {
    std::string rule;
    for (const Word& allowed : choice.words) {
      if (allowed.now.empty()) rule.append(rule.empty() ? "one of " : ", ").append(allowed.text);
    }
    return rule;
  }

  const Key& key;
};

}  // namespace

std::string path_of(const Block& block, const Key& key) {
  return (key.group.empty() ? std::string(block.name) : group_path_of(block, key)) + "." + std::string(key.name);
}

std::string group_path_of(const Block& block, const Key& key) {
  return key.group.empty() ? "" : std::string(block.name) + "." + std::string(key.group);
}

std::string rule_of_group(const Schema& schema, std::string_view path) {
  std::string names;
  for (const Block& block : schema.blocks) {
    for (const Key& key : block.keys) {
      if (key.group.empty() || group_path_of(block, key) != path) continue;
      names.append(names.empty() ? "a map of " : ", ").append(key.name);
    }
  }
  return names;
}

std::string rule_of(const Key& key) {
  return std::visit(Rule{key}, key.field);
}

}  // namespace robot_control
