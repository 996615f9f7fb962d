#pragma once
/// A log in memory in the form of the log's reader: rows and snapshots. The rows hold only the checksum of a frame that
/// a law computed.

#include <cstdint>
#include <string>
#include <vector>

#include "log/messages/trace_message.h"
#include "log/replay/replay.h"
#include "simulation/closed_loop.h"

namespace robot_control {

inline Parameters default_parameters() {
  return read_parameters(std::string(PROJECT_DIRECTORY) + "/config/robot_params.yaml", {});
}

/// The log holds the head of a frame that its law computed, and near a snapshot all of it.
template <class Frame>
void cut(const LawRow& law, Frame& frame) {
  if (frame.head.checksum != law.output || near_snapshot(frame.head.cycle)) return;
  const FrameHead head = frame.head;
  frame = Frame{};
  frame.head = head;
}

struct RecordedRow {
  std::int64_t run = 0;
  std::uint64_t cycle = 0;
  bool repeats = false;
  bool has_driver = false, has_estimator = false, has_controller = false, has_monitor = false;
  DriverTrace driver;
  EstimatorTrace estimator;
  ControllerTrace controller;
  MonitorTrace monitor;

  RecordedRow() = default;
  explicit RecordedRow(const JoinedRow& row) : run(row.run), cycle(row.cycle), repeats(row.repeats) {
    if ((has_driver = row.driver != nullptr)) driver = *row.driver;
    if ((has_estimator = row.laws.estimator != nullptr)) estimator = *row.laws.estimator;
    if ((has_controller = row.laws.controller != nullptr)) controller = *row.laws.controller;
    if ((has_monitor = row.laws.monitor != nullptr)) monitor = *row.laws.monitor;
    cut(estimator.calls.law, estimator.state);
    cut(controller.calls.law, controller.command);
    cut(monitor.calls.law, monitor.permit);
  }

  JoinedRow joined() const {
    JoinedRow row{.run = run, .cycle = cycle, .time = 0};
    if (has_driver) row.driver = &driver;
    row.repeats = repeats;
    row.set({has_estimator ? &estimator : nullptr, has_controller ? &controller : nullptr,
             has_monitor ? &monitor : nullptr});
    return row;
  }
};

struct Recording {
  std::vector<RecordedRow> rows;
  std::vector<LawSnapshot> snapshots;

  void add(const LawSnapshot* snapshot) {
    if (snapshot == nullptr) return;
    snapshots.push_back(*snapshot);
    seal(snapshots.back());
  }

  void add(const ClosedLoop& loop) {
    for (const LawSnapshot* snapshot : loop.snapshots()) add(snapshot);
    rows.emplace_back(loop.row());
  }

  ReplayReport replay(const Robot& robot, double period) const {
    Replay again(robot, period);
    for (const LawSnapshot& snapshot : snapshots) again.add(snapshot);
    for (const RecordedRow& row : rows) again.add(row.joined());
    return again.report();
  }
};

/// The messages of a log in their order, each with its time.
struct LoggedMessage {
  std::string bytes = {};
  std::int64_t time_ns = 0;
};

inline void log(const JoinedRow& row, std::size_t joints, std::vector<LoggedMessage>& messages) {
  LoggedMessage& message = messages.emplace_back();
  message.time_ns = 1'000'000 * static_cast<std::int64_t>(messages.size());
  encode_trace({.row = row, .joints = joints, .time_ns = message.time_ns}, message.bytes);
}

/// Replays them as from a file. Throws TraceError: a message cannot be read.
inline ReplayReport replay(const std::vector<LoggedMessage>& messages, const std::vector<LawSnapshot>& snapshots,
                           const Robot& robot, double period) {
  static const TraceDecoder kDecoder(trace_definition());
  Replay again(robot, period);
  for (const LawSnapshot& snapshot : snapshots) again.add(snapshot);
  TraceRow row;
  for (const LoggedMessage& message : messages) {
    kDecoder.decode(message.bytes, row);
    again.add(row, message.bytes, message.time_ns);
  }
  return again.report();
}

/// The errors as text, for the output of a test.
inline std::string text_of(const ReplayReport& report) {
  std::string text;
  for (std::size_t i = 0; i < kLaws; ++i) {
    const LawReport& law = report.laws[i];
    text += std::string(name_of(static_cast<LawName>(i))) + ": " + std::to_string(law.compared) + " compared, " +
            std::to_string(law.different) + " different, " + std::to_string(law.not_compared) + " not compared\n";
  }
  for (std::size_t i = 0; i < report.differences.size() && i < 8; ++i) text += sentence(report.differences[i]) + "\n";
  for (const ReplayGap& gap : report.gaps) text += sentence(gap) + "\n";
  return text;
}

}  // namespace robot_control
