#pragma once
/// The black box holds the rows of the four nodes and the snapshots of their laws in a ring file (black_box_file.h).
///
/// They have the layout of memory and the order in which they arrive, before they are joined: a dead node would delay
/// the join. Each is compressed by itself. Only the build that wrote such a file can read it.

#include <cstdint>
#include <string>
#include <vector>

#include "log/black_box/black_box_file.h"
#include "log/messages/log_messages.h"
#include "signals/trace.h"

namespace robot_control {

/// Each record has a kind; the first four are those of TraceRing.
enum class BlackBoxKind : std::uint32_t { kDriver, kEstimator, kController, kMonitor, kSnapshot, kState, kHeader };

/// This state holds for the records that follow.
struct BlackBoxState {
  std::int64_t time_offset_ns = 0;  ///< ROS time − stamps
  std::uint64_t lost = 0;           ///< rows that were lost before they reached the black box
};

/// The file's description begins with the build that wrote the file, by `hex`; the header follows.
inline constexpr std::size_t kBlackBoxBuildLength = 16;

class BlackBox {
 public:
  /// Makes a file with room for `bytes`. `build` is build_id(). Throws LogError.
  BlackBox(const std::string& path, std::size_t bytes, std::uint64_t build, const LogHeader& header);

  void add(const DriverTrace& row) noexcept;
  void add(const EstimatorTrace& row) noexcept;
  void add(const ControllerTrace& row) noexcept;
  void add(const MonitorTrace& row) noexcept;

  /// A snapshot comes before the row to which it belongs.
  void add(const LawSnapshot& snapshot) noexcept;

  /// Adds the BlackBoxState of the records that follow.
  void add_state(std::int64_t time_offset_ns, std::uint64_t lost) noexcept;

  /// `encoded` is a LogHeader that holds from here on. A header longer than a segment is left out.
  void add_header(std::string_view encoded) noexcept {
    file_.append(static_cast<std::uint32_t>(BlackBoxKind::kHeader), 0, encoded);
  }

  /// Marks an orderly end (black_box_file.h); nothing may be added afterwards.
  void mark_ended() noexcept { file_.mark_ended(); }

  bool at_its_path() const noexcept { return file_.at_its_path(); }

  /// The time between the oldest and the newest added row, s.
  double seconds_added() const noexcept;

  /// The seconds of rows that the file can hold at the rate so far; 0: not known yet.
  double seconds_held() const noexcept;

 private:
  void add_bytes(BlackBoxKind kind, std::int64_t stamp_ns, const void* data, std::size_t size) noexcept;

  std::vector<char> packed_;
  std::int64_t first_ns_ = 0;  ///< stamp of the first row; 0: there is none
  std::int64_t newest_ns_ = 0;
  BlackBoxFile file_;
};

}  // namespace robot_control
