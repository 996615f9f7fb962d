#pragma once

#include <cstdint>
#include <string>

#include "parameters/block.h"

namespace robot_control {

/// The mode decides which cycles run.bag holds.
enum class RecordMode {
  kMotion,   ///< cycles while the robot moves, and those before (log/bag_log.h)
  kAlways,   ///< all cycles
  kRequest,  ///< cycles between two calls of the service
  kOff,      ///< there is no run.bag
};

inline std::vector<Word> words_of(RecordMode) {
  using enum RecordMode;
  return {{"motion", kMotion}, {"always", kAlways}, {"request", kRequest}, {"off", kOff}};
}

struct TelemetryParameters {
  std::string directory;  ///< where runs are written; empty or relative: from where the node was started
  RecordMode record = RecordMode::kMotion;
  double split_size = 1;         ///< GB (10⁹ bytes), of one run.bag; 0: no limit
  double split_time = 3600;      ///< s, of one run.bag; 0: no limit
  double quota = 5;              ///< GB of all runs in `directory` together; 0: no limit
  double black_box = 0.2;        ///< GB of the ring in `directory`/black_box, wall clock only; 0: there is none
  std::uint64_t incidents = 10;  ///< of each kind, the newest that are kept (recording/black_box); 0: none is saved
};

inline Keys keys(TelemetryParameters& telemetry) {
  return {
      {"directory", &telemetry.directory, {}, 0, 0, kMayBeEmpty},
      {"record", &telemetry.record},
      {"split_size", &telemetry.split_size, "GB", 0.001, 1.0e6, kZeroIsOff},
      {"split_time", &telemetry.split_time, "s", 1, 1.0e9, kZeroIsOff},
      {"quota", &telemetry.quota, "GB", 0.001, 1.0e6, kZeroIsOff},
      {"black_box", &telemetry.black_box, "GB", 0.001, 100, kZeroIsOff},
      {"incidents", &telemetry.incidents, {}, 1, 10000, kZeroIsOff},
  };
}

}  // namespace robot_control
