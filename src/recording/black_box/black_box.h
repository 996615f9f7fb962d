#pragma once
/// The rows of the four nodes and the snapshots of their laws in a ring file (black_box_file.h), as they are in memory
/// and in the order in which they are taken: before they are joined, which a dead node delays. Each is compressed by
/// itself. Only the build that wrote such a file can read it.

#include <cstdint>
#include <string>
#include <vector>

#include "recording/black_box/black_box_file.h"
#include "recording/log_messages.h"
#include "signals/trace.h"

namespace robot_control {

/// Of a record; the first four as TraceRing.
enum class BlackBoxKind : std::uint32_t { kDriver, kEstimator, kController, kMonitor, kSnapshot, kState, kHeader };

/// Of the records that follow.
struct BlackBoxState {
  std::int64_t time_offset_ns = 0;  ///< ROS time − stamps
  std::uint64_t lost = 0;           ///< rows on the way here
};

/// The file's description begins with its build, which only programs of the same build can read; then comes the header.
inline constexpr std::size_t kBlackBoxBuildLength = 16;
std::string black_box_build(std::uint64_t build);

class BlackBox {
 public:
  /// A new file with room for `bytes`. `build`: build_id(). Throws LogError.
  BlackBox(const std::string& path, std::size_t bytes, std::uint64_t build, const LogHeader& header);

  void add(const DriverTrace& row) noexcept;
  void add(const EstimatorTrace& row) noexcept;
  void add(const ControllerTrace& row) noexcept;
  void add(const MonitorTrace& row) noexcept;

  /// Before the row to which it belongs.
  void add(const LawSnapshot& snapshot) noexcept;

  /// BlackBoxState of all that follows.
  void add_state(std::int64_t time_offset_ns, std::uint64_t lost) noexcept;

  /// `encoded`: a LogHeader that holds from here on. One that is longer than a segment is left out.
  void add_header(std::string_view encoded) noexcept {
    file_.append(static_cast<std::uint32_t>(BlackBoxKind::kHeader), 0, encoded);
  }

  /// Nothing is added any more; see black_box_file.h.
  void mark_ended() noexcept { file_.mark_ended(); }

  bool at_its_path() const noexcept { return file_.at_its_path(); }

  /// Between the oldest and the newest row that was added, s.
  double seconds_added() const noexcept;

  /// Of rows, that it can hold at the rate so far; 0: not known yet.
  double seconds_held() const noexcept;

 private:
  void add_bytes(BlackBoxKind kind, std::int64_t stamp_ns, const void* data, std::size_t size) noexcept;

  std::vector<char> packed_;
  std::int64_t first_ns_ = 0;  ///< stamps of rows; 0: none
  std::int64_t newest_ns_ = 0;
  BlackBoxFile file_;
};

}  // namespace robot_control
