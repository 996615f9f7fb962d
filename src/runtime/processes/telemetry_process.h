#pragma once
/// The log's reader: takes the rows of the four trace rings, joins them by cycle and writes run.csv.
///
/// It owns the read positions. Only once all four rings are mapped and the positions stored does it say so
/// (head.attached_run = 1): from then on, in lockstep, a full ring makes its writer wait, so no row is lost.
///
/// A disk that takes no more ends the log, not this process: the rings are still emptied, so that no node waits for
/// space, and what is not written is counted. So does a log that fills telemetry.quota (log_folder.h).

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hal/bus.h"
#include "parameters/parameters.h"
#include "robot/robot_model.h"
#include "rt/ring.h"
#include "telemetry/csv_writer.h"
#include "telemetry/join.h"
#include "telemetry/log_folder.h"

namespace robot_control {

struct TelemetryCounts {
  JoinCounts join;
  std::uint64_t dropped = 0;      ///< by the writers, for want of room, since this process began
  std::uint64_t overwritten = 0;  ///< before they were read
  std::uint64_t unwritten = 0;    ///< rows that the disk did not take; before `problem`, those that still wait for it
};

class TelemetryProcess {
 public:
  /// Writes run.csv in the parameters' directory; an earlier one is kept as run.N.csv. Throws BusError (another
  /// telemetry reads), LogError.
  TelemetryProcess(const Parameters& parameters, const RobotModel& robot, const std::string& bus);
  ~TelemetryProcess();
  TelemetryProcess(const TelemetryProcess&) = delete;
  TelemetryProcess& operator=(const TelemetryProcess&) = delete;

  /// At 10 Hz: maps rings as they appear or are replaced, hands what was written to the system.
  void poll();

  /// Takes all rows that are there; the number of them. Call often: a ring holds 2048 cycles.
  std::size_t drain();

  /// Takes the rest and closes the file; throws LogError where rows are missing there. Only `counts` and `problem` may
  /// be called afterwards.
  void finish();

  /// Nodes whose ring is not there or not owned by a running process.
  std::vector<std::string> missing() const;

  TelemetryCounts counts() const;

  /// Older logs that were removed since the last call, for telemetry.quota.
  std::vector<std::string> take_removed() { return folder_.take_removed(); }

  /// Why the log has ended; empty: it has not.
  const std::string& problem() const noexcept { return problem_; }
  const std::string& path() const noexcept { return path_; }

 private:
  template <class Row>
  class Source;
  struct Sources;

  /// Notes a LogError.
  template <class Act>
  void write_down(Act act);

  OwnedChannel<RingPositions> positions_;
  LogFolder folder_;
  std::string path_;
  CsvWriter csv_;
  std::string problem_;
  Join join_;
  std::unique_ptr<Sources> sources_;
};

}  // namespace robot_control
