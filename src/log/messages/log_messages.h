#pragma once
/// These functions encode the other two messages of a log: msg/TraceHeader.msg and msg/Snapshot.msg.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "signals/law_snapshot.h"

namespace robot_control {

/// A log begins with its header, which holds everything that its rows need to be understood and replayed.
struct LogHeader {
  std::string robot = {};
  std::string kind = {};  ///< MachineModel::kind
  std::vector<std::string> joints = {};
  std::vector<std::string> roles = {};     ///< of each joint: "driven", "passive" or "held"
  std::vector<std::string> contacts = {};  ///< MachineModel::contacts
  std::uint32_t wheels = 0;                ///< the first joints are those of the wheels
  double period = 0;                       ///< s
  std::string clock = {};                  ///< "wall" or "lockstep"
  std::string record = {};                 ///< "motion", "always" or "request", as telemetry.record
  std::uint32_t part = 0;                  ///< number of the file among those of one process: 0, 1, …
  std::string parameters = {};             ///< YAML: every value in force when the log began
  std::string urdf = {};
  std::string scene = {};        ///< text of the simulated world; empty: none
  std::string calibration = {};  ///< text of the calibration file; empty: none
  std::string version = {};      ///< version of this package
  std::string build = {};        ///< compiler, flags, build type
  std::string host = {};
  std::string kernel = {};
  std::string processor = {};
  std::string libraries = {};  ///< C library
  std::string missing = {};    ///< unreadable parts of a black box, as a sentence; empty: none
  std::string checksum = {};   ///< checksum of all fields before it, 8 hexadecimal digits; `encode` computes it again
};

/// The figures of the loop's timing at one moment.
struct TraceSummary {
  std::int64_t stamp_ns = 0;  ///< on the clock of the rows' stamps

  /// Durations, ns. `names` says "driver.wake_up" for those since the log began, and "driver.wake_up.10s".
  std::vector<std::string> names = {};
  std::vector<std::uint64_t> samples = {};
  std::vector<std::int64_t> min = {};
  std::vector<std::int64_t> p50 = {};
  std::vector<std::int64_t> p99 = {};
  std::vector<std::int64_t> p999 = {};
  std::vector<std::int64_t> max = {};

  std::vector<std::string> counters = {};  ///< "driver.page_faults"
  std::vector<std::uint64_t> counts = {};
};

/// True: the checksum of the header is that of its fields.
bool intact(const LogHeader& header);

std::string encode(const LogHeader& header);      ///< sealed
std::string encode(const LawSnapshot& snapshot);  ///< sealed
std::string encode(const TraceSummary& summary);

/// `definition` is the text of the .msg with which the header was recorded; it names the fields. A field that it lacks
/// keeps its default. Throws TraceError.
LogHeader decode_header(std::string_view message, const std::string& definition);

/// Throws TraceError.
LawSnapshot decode_snapshot(std::string_view message);

}  // namespace robot_control
