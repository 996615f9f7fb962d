#pragma once
/// A drive for a black box.

#include <gtest/gtest.h>

#include "log/bag_log.h"
#include "log/black_box/black_box.h"
#include "log/black_box/saved_black_box.h"
#include "log/trace_reader.h"
#include "loop/log_header.h"
#include "recorded_drive.h"
#include "support/recorded_loop.h"
#include "support/temporary_folder.h"

namespace robot_control {

inline constexpr std::size_t kBytes = 32 << 20;

/// A drive that goes to a black box and to a run.bag at the same time.
struct ABlackBox : testing::Test {
  ABlackBox() {
    TelemetryParameters all;
    all.record = RecordMode::kAlways;
    log = std::make_unique<BagLog>(logs, header(), all);
  }

  LogHeader header() const { return log_header(drive_parameters(), loop.robot()); }
  std::string path(const std::string& name) const { return folder.path() / name; }

  void drive_on(BlackBox& box, std::uint64_t cycles) {
    box.set_state(0, 0);
    drive(loop, cycles, [&](const JoinedRow& row) {
      for (const LawSnapshot* snapshot : loop.snapshots()) {
        if (snapshot == nullptr) continue;
        box.add(*snapshot);
        log->write(*snapshot);
      }
      box.add(*row.driver);
      box.add(*row.estimator);
      box.add(*row.controller);
      box.add(*row.monitor);
      log->write(row);
      box.flush();
    });
  }

  SavedBlackBox save() const { return save_black_box(path("ring"), path("saved/run.bag")); }

  TemporaryFolder folder;
  RecordedLoop loop{drive_parameters()};
  LogFolder logs{folder.path() / "log", 0};
  std::unique_ptr<BagLog> log;
};

inline std::vector<std::uint64_t> cycles_of(const std::string& bag) {
  std::vector<std::uint64_t> cycles;
  TraceReader(bag).read({.row = [&](const TraceRow& row, std::int64_t) { cycles.push_back(row.cycle); }});
  return cycles;
}

}  // namespace robot_control
