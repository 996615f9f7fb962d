#pragma once
/// The other two messages of a log, and their bytes: msg/TraceHeader.msg, msg/Snapshot.msg.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "signals/law_snapshot.h"

namespace robot_control {

/// What a log begins with: everything beside its rows that is needed to understand and to replay them.
struct LogHeader {
  std::string robot = {};
  std::vector<std::string> joints = {};
  std::uint32_t wheels = 0;     ///< the first of the joints
  double period = 0;            ///< s
  std::string clock = {};       ///< "wall" or "lockstep"
  std::string record = {};      ///< "motion", "always" or "request": what is in the log (telemetry.record)
  std::uint32_t part = 0;       ///< of the files of one process: 0, 1, …
  std::string parameters = {};  ///< YAML: every value in force when the log began
  std::string urdf = {};
  std::string scene = {};        ///< text of the simulated world; empty: none
  std::string calibration = {};  ///< text of the calibration file; empty: none
  std::string version = {};      ///< of this package
  std::string build = {};        ///< compiler, flags, build type
  std::string host = {};
  std::string kernel = {};
  std::string processor = {};
  std::string libraries = {};  ///< C library
  std::string missing = {};    ///< of a black box: what could not be read of it, as a sentence; empty: nothing
  std::string checksum = {};   ///< of all before it, 8 hexadecimal digits; `encode` writes another one
};

/// Is this header what `encode` sealed?
bool intact(const LogHeader& header);

std::string encode(const LogHeader& header);      ///< sealed
std::string encode(const LawSnapshot& snapshot);  ///< sealed

/// By the names in `definition`, the text of the .msg with which it was recorded: a field that it has not keeps its
/// default. Throws TraceError.
LogHeader decode_header(std::string_view message, const std::string& definition);

/// Throws TraceError.
LawSnapshot decode_snapshot(std::string_view message);

}  // namespace robot_control
