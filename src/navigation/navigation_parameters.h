#pragma once
/// The blocks `slam`, `localization`, `navigate` and `collision_guard`.

#include <optional>
#include <string>
#include <vector>

#include "parameters/block.h"

namespace robot_control::navigation {

struct SlamParameters {
  std::string map;  ///< YAML file of a saved map that grows on; empty: the map begins empty where the robot is
};

inline Keys keys(SlamParameters& slam) {
  return {{"map", &slam.map, {}, 0, 0, kPath | kMayBeEmpty}};
}

struct LocalizationParameters {
  std::string map;                            ///< YAML file; empty: it waits for load_map
  std::optional<NumberList<3>> initial_pose;  ///< x, y [m], yaw [rad] at the start; none: it waits for initialpose
};

inline Keys keys(LocalizationParameters& localization) {
  return {{"map", &localization.map, {}, 0, 0, kPath | kMayBeEmpty},
          {"initial_pose", &localization.initial_pose, "m, m, rad", -1e6, 1e6, kOptional}};
}

struct NavigateParameters {
  double speed = 0.5;            ///< m/s of a goal that names none
  bool unknown_is_free = false;  ///< goals and paths may lie where neither map nor laser has been
  std::string map_frame = "map";
  std::string zones;  ///< YAML file of a mask of zones (zones.h); empty: there are none
};

inline Keys keys(NavigateParameters& navigate) {
  return {{"speed", &navigate.speed, "m/s", 0.01, 10},
          {"unknown_is_free", &navigate.unknown_is_free},
          {"map_frame", &navigate.map_frame},
          {"zones", &navigate.zones, {}, 0, 0, kPath | kMayBeEmpty}};
}

enum class GuardMode { kOff, kSlowAndStop };

inline std::vector<Word> words_of(GuardMode) {
  return {{"off", GuardMode::kOff}, {"slow_and_stop", GuardMode::kSlowAndStop}};
}

struct GuardParameters {
  GuardMode guard = GuardMode::kSlowAndStop;
  std::vector<std::string> scans = {"scan"};  ///< topics, one per laser
};

inline Keys keys(GuardParameters& guard) {
  return {{"guard", &guard.guard}, {"scans", &guard.scans}};
}

}  // namespace robot_control::navigation
