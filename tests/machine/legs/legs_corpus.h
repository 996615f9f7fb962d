#pragma once
/// The real quadrupeds (support/robots/corpus.h) with their facts, and the project's own quadruped.

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "machine/legs/leg_model.h"
#include "support/robots/corpus.h"

namespace robot_control {

inline YAML::Node quadruped_facts() {
  return YAML::LoadFile((quadrupeds() / "FACTS.json").string());
}

/// Returns "quadbot", then the real ones.
inline std::vector<std::string> legged_robots() {
  std::vector<std::string> names{"quadbot"};
  if (quadrupeds().empty()) return names;
  for (const auto& entry : quadruped_facts()) names.push_back(entry.first.as<std::string>());
  return names;
}

/// Returns those of every run, or the others, which are built as a1 is: by the same maker, and heavier.
inline std::vector<std::string> legged_robots(bool of_every_run) {
  std::vector<std::string> names = legged_robots();
  std::erase_if(names, [&](const std::string& name) {
    return (name == "aliengo" || name == "go1" || name == "go2") == of_every_run;
  });
  return names;
}

inline RobotDescription legged_description(const std::string& name) {
  if (name == "quadbot") return load_description(PROJECT_DIRECTORY "/urdf/quadbot.urdf");
  return load_description((quadrupeds() / name / "robot.urdf").string());
}

inline LegModel legged_robot(const std::string& name, const LegParameters& legs = {}) {
  return read_legs(legged_description(name), {}, legs);
}

inline std::string robot_name(const testing::TestParamInfo<std::string>& robot) {
  return robot.param;
}

}  // namespace robot_control
