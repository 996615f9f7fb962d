#include "parameters/parameters.h"

#include <set>

#include "control/limits/drive_limits.h"
#include "parameters/parameter_tree.h"
#include "parameters/problem_list.h"
#include "parameters/schema/schema.h"
#include "parameters/suggestion.h"
#include "parameters/tree_reader.h"
#include "parameters/value_reader.h"

namespace robot_control {
namespace {

class TreeReader {
 public:
  TreeReader(ParameterTree tree, std::span<const Block> blocks, std::string source, const Parameters& base,
             ProblemList& problems)
      : tree_(std::move(tree)), blocks_(blocks), source_(std::move(source)), problems_(problems), parameters_(base) {}

  Parameters read() {
    higher_layers_replace_other_names();
    refuse_unknown();
    for (const Block& block : blocks_) {
      for (const Key& key : block.keys) read_key(block, key);
    }
    for (const Block& block : blocks_) {
      for (const Key& key : block.keys) check_against_others(block, key);
    }
    check_contradictions();
    return std::move(parameters_);
  }

 private:
  // wheel_separation and wheel_base name one value: if a higher layer sets one name, the other name is removed from the
  // lower layers.
  void higher_layers_replace_other_names() {
    for (const Block& block : schema()) {
      for (const Key& key : block.keys) {
        if (key.other_name_of.empty()) continue;
        const std::string one = path_of(block, key);
        const std::string other = std::string(block.name) + "." + std::string(key.other_name_of);
        if (layer_of(one) > layer_of(other)) tree_.entries.erase(other);
        if (layer_of(other) > layer_of(one)) tree_.entries.erase(one);
      }
    }
  }

  /// Returns the layer that gives the value: 0 none, 1 the base file, 2 the file, 3 an overlay.
  int layer_of(const std::string& path) const {
    const auto entry = tree_.entries.find(path);
    if (entry == tree_.entries.end()) return 0;
    return entry->second.overlay ? 3 : entry->second.base ? 1 : 2;
  }

  void refuse_unknown() {
    std::set<std::string, std::less<>> blocks;
    std::set<std::string, std::less<>> paths;
    for (const Block& block : schema()) {
      blocks.emplace(block.name);
      for (const Key& key : block.keys) paths.insert(path_of(block, key));
    }
    // Keys inside an unexpected or unknown map are reported with that map. A server can hold keys below a key whose
    // value in the file is no map; these are reported themselves.
    const auto reported_with_its_map = [&](const std::string& path) {
      const std::string map = path.substr(0, path.rfind('.'));
      const auto entry = tree_.entries.find(map);
      return map.find('.') != std::string::npos && entry != tree_.entries.end() &&
             entry->second.kind == Entry::Kind::kMap && rule_of_group(map).empty();
    };
    for (const BlockEntry& block : tree_.blocks) {
      if (blocks.contains(block.name)) continue;
      problems_.add({printable(block.name), "", "unknown block", block.origin, suggest_block(block.name)});
    }
    for (const auto& [path, entry] : tree_.entries) {
      const bool reported_with_its_block = !entry.overlay && !blocks.contains(path.substr(0, path.find('.')));
      if (paths.contains(path) || !rule_of_group(path).empty()) continue;
      if (reported_with_its_block || reported_with_its_map(path)) continue;
      problems_.add({printable(path), as_written(entry), "unknown key", entry.origin, suggest_key(path)});
    }
  }

  void read_key(const Block& block, const Key& key) {
    const std::string path = path_of(block, key);
    const std::string group = group_path_of(block, key);
    if (!group.empty() && !group_is_there(group)) return;
    const auto entry = tree_.entries.find(path);
    if (entry != tree_.entries.end()) {
      if (read_value(entry->second, path, key, key.field(parameters_), problems_)) sound_.insert(path);
      if (const std::string_view now = word_now(entry->second, key.field(parameters_)); !now.empty()) {
        parameters_.warnings.push_back(path + " = " + as_written(entry->second) + " is an old value: write " +
                                       std::string(now) + " [" + entry->second.origin + "]");
      }
      if ((key.traits & kNoEffect) != 0) {
        parameters_.warnings.push_back(path + " has no effect any more: leave it out [" + entry->second.origin + "]");
      }
    } else if ((key.traits & kOptional) == 0) {
      const auto map = tree_.entries.find(group);
      const std::string& place = map == tree_.entries.end() ? source_ : map->second.origin;
      problems_.add({path, "", "missing", place, "add it: " + rule_of(key)});
    }
  }

  // Returns whether all keys of the group are optional.
  static bool may_be_absent(const std::string& group) {
    for (const Block& block : schema()) {
      for (const Key& key : block.keys) {
        if (group_path_of(block, key) == group && (key.traits & kOptional) == 0) return false;
      }
    }
    return true;
  }

  // Returns whether the map of the group exists. If it is missing or no map, this is one problem instead of one per
  // key.
  bool group_is_there(const std::string& group) {
    const auto entry = tree_.entries.find(group);
    const bool map = entry != tree_.entries.end() && entry->second.kind == Entry::Kind::kMap;
    const auto first_inside = tree_.entries.lower_bound(group + ".");
    const bool overlaid_alone = entry == tree_.entries.end() && first_inside != tree_.entries.end() &&
                                first_inside->first.starts_with(group + ".");
    if (map || overlaid_alone) return true;
    if (entry == tree_.entries.end() && may_be_absent(group)) return false;
    if (!reported_groups_.insert(group).second) return false;
    const std::string rule = rule_of_group(group);
    if (entry == tree_.entries.end()) {
      problems_.add({group, "", "missing", source_, "add it: " + rule});
    } else {
      problems_.add({group, as_written(entry->second), "must be " + rule, entry->second.origin, ""});
    }
    return false;
  }

  // Refuses values that contradict each other, although each is valid by itself.
  void check_contradictions() {
    const auto refuse = [&](const std::string& path, const std::string& rule) {
      const Entry& entry = tree_.entries.at(path);
      problems_.add({path, as_written(entry), rule, entry.origin, ""});
    };
    const std::string low = "safety_monitor.battery_low.limit";
    const std::string empty = "safety_monitor.battery_empty.limit";
    const SafetyParameters& safety = parameters_.safety;
    if (sound_.contains(low) && sound_.contains(empty) && *safety.battery_empty.limit >= *safety.battery_low.limit) {
      const Entry& entry = tree_.entries.at(low);
      refuse(empty, "must be below " + low + " = " + as_written(entry) + " [" + entry.origin + "]");
    }
    const DriveControllerParameters& drive = parameters_.controller;
    const SpeedLimits limits = speed_limits(drive);
    const auto check_axis = [&](const std::string& axis, const MotionLimits& axis_limits, bool own_deceleration,
                                std::optional<double> jerk) {
      const std::string block = "diff_drive_controller.max_" + axis;
      const std::string emergency = block + "_emergency_deceleration";
      const std::string usual = block + (own_deceleration ? "_deceleration" : "_acceleration");
      if (sound_.contains(emergency) && sound_.contains(usual) &&
          axis_limits.emergency_deceleration < axis_limits.deceleration) {
        const Entry& entry = tree_.entries.at(usual);
        refuse(emergency, "must not be below " + usual + " = " + as_written(entry) + " [" + entry.origin + "]");
      }
      const std::string reverse = block + "_deceleration_reverse";
      if (sound_.contains(emergency) && sound_.contains(reverse) &&
          axis_limits.emergency_deceleration < axis_limits.deceleration_from(-1)) {
        const Entry& entry = tree_.entries.at(reverse);
        refuse(emergency, "must not be below " + reverse + " = " + as_written(entry) + " [" + entry.origin + "]");
      }
      // The jerk limit must allow the emergency deceleration to build up.
      constexpr double kBuildUp = 1.0;  // s
      if (!sound_.contains(block + "_jerk") || jerk.value_or(0) == 0) return;
      if (*jerk * kBuildUp >= axis_limits.emergency_deceleration) return;
      const auto entry = tree_.entries.find(emergency);
      const bool given = sound_.contains(emergency) && entry != tree_.entries.end();
      refuse(block + "_jerk", "must be 0 (off) or reach " + emergency + " = " +
                                  (given ? as_written(entry->second) + " [" + entry->second.origin + "]"
                                         : shortest(axis_limits.emergency_deceleration) + " (derived)") +
                                  " within " + shortest(kBuildUp) + " s");
    };
    check_axis("linear", limits.linear, drive.max_linear_deceleration.has_value(), drive.max_linear_jerk);
    check_axis("angular", limits.angular, drive.max_angular_deceleration.has_value(), drive.max_angular_jerk);
    // A stop takes the sensors of one cycle, the permit of the next and the torque of the one after.
    constexpr double kCyclesToStop = 3;
    const std::string delay = "safety_monitor.stop_delay";
    const double fastest = kCyclesToStop * parameters_.loop.period();
    if (sound_.contains(delay) && sound_.contains("robot.rate") && safety.stop_delay < fastest) {
      refuse(delay, "must be at least three periods, " + shortest(fastest) + " s at " +
                        shortest(parameters_.loop.rate) + " Hz: no stop is faster");
    }
  }

  // Checks the rules that need a second value. A value that was already refused is not checked again.
  void check_against_others(const Block& block, const Key& key) {
    const std::string path = path_of(block, key);
    if (!sound_.contains(path)) return;
    const Entry& entry = tree_.entries.at(path);
    const auto refuse = [&](const std::string& rule, const std::string& remedy) {
      problems_.add({path, as_written(entry), rule, entry.origin, remedy});
    };
    const LoopParameters& loop = parameters_.loop;
    const Field field = key.field(parameters_);
    const bool rate_known = sound_.contains("robot.rate") || !tree_.entries.contains("robot.rate");
    if ((key.traits & kTimeout) != 0 && rate_known) {
      const double timeout = *std::get<double*>(field);
      if (timeout != 0 && timeout < 2 * loop.period()) {
        refuse("must be 0 (off) or at least two periods, " + shortest(2 * loop.period()) + " s at " +
                   shortest(loop.rate) + " Hz",
               "");
      }
    }
    if ((key.traits & kPublishRate) != 0 && rate_known && *std::get<double*>(field) > loop.rate) {
      refuse("must be at most the loop's rate, " + shortest(loop.rate) + " Hz", "lower it or raise robot.rate");
    }
    if (!key.other_name_of.empty()) check_other_name(block, key, refuse);
  }

  template <class Refuse>
  void check_other_name(const Block& block, const Key& key, Refuse refuse) {
    const std::string other = std::string(block.name) + "." + std::string(key.other_name_of);
    if (!sound_.contains(other)) return;
    Parameters one;
    Parameters two;
    ProblemList none;
    read_value(tree_.entries.at(path_of(block, key)), other, key, key.field(one), none);
    read_value(tree_.entries.at(other), other, key, key.field(two), none);
    const auto equals_other = [&](auto* value) { return *value == *std::get<decltype(value)>(key.field(two)); };
    if (std::visit(equals_other, key.field(one))) return;
    const Entry& entry = tree_.entries.at(other);
    refuse("is another name of " + other + " = " + as_written(entry) + " [" + entry.origin + "] and differs",
           "give one of them");
  }

  ParameterTree tree_;
  std::span<const Block> blocks_;
  std::string source_;  ///< origin in the message about a missing value
  ProblemList& problems_;
  Parameters parameters_;
  std::set<std::string, std::less<>> sound_;            ///< paths whose value was accepted
  std::set<std::string, std::less<>> reported_groups_;  ///< groups that are no maps
};

}  // namespace

Parameters read_blocks(ParameterTree tree, std::span<const Block> blocks, const std::string& source,
                       const Parameters& base, ProblemList& problems) {
  return TreeReader(std::move(tree), blocks, source, base, problems).read();
}

Parameters read_parameters(const std::string& yaml_path, const std::vector<Overlay>& overlays,
                           const std::string& base_path) {
  const std::string source = yaml_path.empty() ? "the given values" : yaml_path;
  const std::string subject = "parameters refused (" + source + ")";
  ProblemList problems;
  ParameterTree tree = read_tree(yaml_path, overlays, problems, base_path);
  if (tree.blocks.empty() && !yaml_path.empty())
    problems.throw_if_any(subject);  // without any block the file is no parameter file
  Parameters parameters = read_blocks(std::move(tree), schema(), source, {}, problems);
  problems.throw_if_any(subject);
  return parameters;
}

}  // namespace robot_control
