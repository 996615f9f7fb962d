#pragma once
/// The reader of the trace: takes the rows of the four rings, joins them by cycle and writes run.bag.
/// The black box (log/black_box) joins them by itself, because it waits less for a dead node. The causes that latched a
/// stop are read from the newest permit. On the wall clock it adds the figures of the timing to run.bag
/// (timing_summary.h).
///
/// It owns the read positions. It announces itself only once all four rings are mapped and the positions stored
/// (head.attached_run = 1): from then on, in lockstep, a full ring makes its writer wait, so no row is lost.
///
/// A full disk ends a file, not this process. The rings are still emptied, so that no node waits for space. Rows that
/// are not written are counted, and another file is tried (log/bag_log.h).

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "bus/bus.h"
#include "bus/ring.h"
#include "configuration/parameters.h"
#include "log/bag_log.h"
#include "log/black_box/black_box_keeper.h"
#include "log/log_folder.h"
#include "log/rows/join.h"
#include "loop/processes/process.h"
#include "loop/processes/timing_summary.h"
#include "robots/robot.h"

namespace robot_control {

struct TelemetryCounts {
  JoinCounts join;
  std::uint64_t dropped = 0;        ///< by the writers, for want of room, since this process began
  std::uint64_t overwritten = 0;    ///< before they were read
  std::uint64_t bag_rows = 0;       ///< rows in run.bag and those before it of this process
  std::uint64_t bag_unwritten = 0;  ///< rows that the disk did not take
  std::uint64_t incidents = 0;      ///< that were saved by this process
};

class TelemetryProcess {
 public:
  /// Writes into the parameters' directory; earlier logs are kept as run.N.bag. Throws BusError (another
  /// telemetry reads), LogError (also: no room for the black box).
  TelemetryProcess(const Parameters& parameters, const Robot& robot, const std::string& bus);
  ~TelemetryProcess();
  TelemetryProcess(const TelemetryProcess&) = delete;
  TelemetryProcess& operator=(const TelemetryProcess&) = delete;

  /// At 10 Hz: maps rings as they appear or are replaced, hands what was written to the system.
  void poll();

  /// Takes all rows that are there; the number of them. Call every 2 ms: what was not taken yet is missing in the black
  /// box after a crash; a ring holds 2048 cycles.
  std::size_t drain();

  /// Takes the rest and closes the files; throws LogError where rows are missing there. Only `counts` and `problem` may
  /// be called afterwards.
  void finish();

  /// Until it is taken back, run.bag holds every cycle, whatever telemetry.record says.
  void request_recording(bool on) noexcept {
    if (bag_ != nullptr) bag_->request(on);
  }

  /// Changes where a node has begun or has taken live parameters over: it may have others than a header says.
  std::uint64_t parameter_changes() const noexcept { return parameter_changes_; }

  /// The header of the logs that begin from now on; joints and period stay.
  void set_header(const LogHeader& header);

  /// Nodes whose ring is not there or not owned by a running process.
  std::vector<std::string> missing() const;

  TelemetryCounts counts() const;

  /// Older logs that were removed since the last call, for telemetry.quota.
  std::vector<std::string> take_removed() { return folder_.take_removed(); }

  /// Notes on what was saved of the black box, or could not be, since the last call.
  std::vector<std::string> take_notes();

  /// Why a log has ended, or run.bag waits for the disk; empty: nothing is wrong.
  const std::string& problem() const noexcept { return problem_; }

  /// Paths of run.bag and of the black box; empty: it is not written.
  const std::string& bag_path() const noexcept { return bag_path_; }
  const std::string& black_box_path() const noexcept { return black_box_path_; }
  bool recording() const noexcept { return bag_ != nullptr && bag_->recording(); }

 private:
  template <class Row>
  class Source;
  struct Sources;

  /// Keeps the message of a LogError for `problem`.
  template <class Act>
  void write_to_bag(Act act);
  template <class Row>
  void receive(const Row& row, std::size_t ring);
  void check_permit();
  TraceSummary summary(std::int64_t now_ns) const;

  Programs programs_;
  OwnedChannel<RingPositions> positions_;
  LogFolder folder_;
  bool lockstep_;
  std::string bag_path_;
  std::unique_ptr<BagLog> bag_;  ///< null: not wanted
  std::string problem_;
  std::string black_box_path_;
  std::unique_ptr<BlackBoxKeeper> black_box_;  ///< null: not wanted
  Input<Permit> permit_;
  bool permit_seen_ = false;  ///< before, stops show in the rows that were there when this process began
  std::array<std::uint64_t, kLaws> law_processes_{};  ///< LawRow::process of the newest rows
  LiveTuning tuning_;                                 ///< of the controller's newest row
  std::uint64_t parameter_changes_ = 0;
  std::unique_ptr<TimingSummary> timing_;  ///< null in lockstep, where no time passes within a cycle
  Join join_;
  std::unique_ptr<Sources> sources_;
};

}  // namespace robot_control
