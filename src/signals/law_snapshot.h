#pragma once
/// A LawSnapshot is a byte copy of the complete state of a law at one moment, from which the law can continue
/// (replay/). Only the build that wrote it can read it.

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <type_traits>

#include "signals/frame_head.h"

namespace robot_control {

/// The laws in the order of the nodes in a row of the log.
enum class LawName : std::uint64_t { kGate = 0, kEstimator = 1, kController = 2, kMonitor = 3 };
inline constexpr std::size_t kLaws = 4;

inline constexpr std::array<std::string_view, kLaws> kLawNames{"gate", "estimator", "controller", "monitor"};

/// The distance of two snapshots of a law in cycles. It is half the length of a trace ring (bus/ring.h). So telemetry
/// that begins to read finds a snapshot in the ring, and all later rows can be replayed.
inline constexpr std::uint64_t kSnapshotCycles = 1024;
inline constexpr std::size_t kSnapshotBytes = 48 * 1024;  ///< bytes of the longest state; that of the monitor has 42 KB

/// A snapshot is taken in a node's first two cycles, in the first cycle of a run and every kSnapshotCycles. It is taken
/// before the step of that cycle, after enter_run of gate, estimator and controller, before set_pose and tune.
struct LawSnapshot {
  FrameHead head;           ///< head of the cycle; sealed outside of the loop
  std::uint64_t build = 0;  ///< build_id() of the program
  LawName law = LawName::kGate;
  std::uint64_t process = 0;  ///< LawRow::process
  std::uint64_t number = 0;   ///< LawRow::number
  std::uint64_t bytes = 0;    ///< used bytes of `state`; the others are 0
  std::array<std::byte, kSnapshotBytes> state{};
};

/// The state of a law is its member `State`, which `state` and `set_state` give and replace; without such a member it
/// is the whole object. Parameters and what the law allocated are not part of `State`. A law with members `save` and
/// `restore` (robots/laws.h) copies its state itself.
template <class Law>
struct StateOf {
  using Type = Law;
};
template <class Law>
requires requires {
  typename Law::State;
}
struct StateOf<Law> {
  using Type = typename Law::State;
};

template <class Law>
void save_state(const Law& law, LawSnapshot& snapshot) noexcept {
  if constexpr (requires { law.save(snapshot); }) {
    law.save(snapshot);
  } else {
    using State = typename StateOf<Law>::Type;
    static_assert(std::is_trivially_copyable_v<State> && sizeof(State) <= kSnapshotBytes);
    snapshot.bytes = sizeof(State);
    if constexpr (std::is_same_v<State, Law>) {
      std::memcpy(snapshot.state.data(), &law, sizeof(State));
    } else {
      std::memcpy(snapshot.state.data(), &law.state(), sizeof(State));
    }
  }
}

/// Returns false if the snapshot has another size.
template <class Law>
bool restore_state(const LawSnapshot& snapshot, Law& law) noexcept {
  if constexpr (requires { law.restore(snapshot); }) {
    return law.restore(snapshot);
  } else {
    using State = typename StateOf<Law>::Type;
    static_assert(std::is_trivially_copyable_v<State> && sizeof(State) <= kSnapshotBytes);
    if (snapshot.bytes != sizeof(State)) return false;
    if constexpr (std::is_same_v<State, Law>) {
      std::memcpy(&law, snapshot.state.data(), sizeof(State));
    } else {
      State state = law.state();
      std::memcpy(&state, snapshot.state.data(), sizeof(State));
      law.set_state(state);
    }
    return true;
  }
}

/// The log keeps complete frames in this many cycles before and after a snapshot of all laws. The restored laws need
/// these frames, which no law computes again.
inline constexpr std::uint64_t kWholeFrames = 8;

constexpr bool near_snapshot(std::uint64_t cycle) noexcept {
  return (cycle + kWholeFrames) % kSnapshotCycles <= 2 * kWholeFrames;
}

}  // namespace robot_control
