#pragma once
/// The complete state of a law at one moment, as it lies in memory: with it the law can run on from there
/// (replay/). Only the build that made it can read it.

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <type_traits>

#include "signals/frame_head.h"

namespace robot_control {

/// In the order of the nodes in a row of the log.
enum class LawName : std::uint64_t { kGate = 0, kEstimator = 1, kController = 2, kMonitor = 3 };
inline constexpr std::size_t kLaws = 4;

/// By LawName: the node in which the law runs.
inline constexpr std::array<std::string_view, kLaws> kLawNodes{"mujoco_plant", "state_estimator",
                                                               "diff_drive_controller", "safety_monitor"};

/// Between two snapshots of a law. Half of what a ring of the trace holds (rt/ring.h): a telemetry that begins to read
/// finds one among the rows that are there, so that whatever comes after can be replayed.
inline constexpr std::uint64_t kSnapshotCycles = 1024;
inline constexpr std::size_t kSnapshotBytes = 40 * 1024;  ///< the longest; that of the monitor has 30 KB

/// Taken in a node's first two cycles, in the first of a run and every kSnapshotCycles: before the step of that cycle,
/// after what LawRow::new_run and MonitorCalls::events stand for, before set_pose and tune.
struct LawSnapshot {
  FrameHead head;           ///< of the cycle; sealed outside of the loop
  std::uint64_t build = 0;  ///< build_id() of the program
  LawName law = LawName::kGate;
  std::uint64_t process = 0;  ///< LawRow::process
  std::uint64_t number = 0;   ///< LawRow::number
  std::uint64_t bytes = 0;    ///< of `state` that are used; the others are 0
  std::array<std::byte, kSnapshotBytes> state{};
};

/// A law's object is its state: it owns nothing outside of itself. (Eigen's small matrices do not, either, though they
/// are not trivially copyable by the letter of C++.)
template <class Law>
inline constexpr bool kCopyableState = std::is_trivially_destructible_v<Law> && sizeof(Law) <= kSnapshotBytes;

template <class Law>
void save_state(const Law& law, LawSnapshot& snapshot) noexcept {
  static_assert(kCopyableState<Law>);
  snapshot.bytes = sizeof(Law);
  std::memcpy(snapshot.state.data(), static_cast<const void*>(&law), sizeof(Law));
}

/// False: it is of another size.
template <class Law>
bool restore_state(const LawSnapshot& snapshot, Law& law) noexcept {
  static_assert(kCopyableState<Law>);
  if (snapshot.bytes != sizeof(Law)) return false;
  std::memcpy(static_cast<void*>(&law), snapshot.state.data(), sizeof(Law));
  return true;
}

/// Cycles before and after one in which all laws are saved. What was published in them is needed whole: the laws that
/// are restored need frames that no law computes again.
inline constexpr std::uint64_t kWholeFrames = 8;

constexpr bool near_snapshot(std::uint64_t cycle) noexcept {
  return (cycle + kWholeFrames) % kSnapshotCycles <= 2 * kWholeFrames;
}

}  // namespace robot_control
