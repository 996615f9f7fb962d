#pragma once
/// The latest frames of one channel: one writer, any number of readers in any process.
///
/// Eight slots; the frame of cycle c lies in slot c mod 8. The writer is wait-free, a reader copies and
/// retries at most kReadTries times. Each slot is a sequence lock whose words are atomics: the writer
/// stores an odd version, then every word with release, then the even version; a reader that loads one
/// new word with acquire therefore sees the odd version afterwards and discards its copy. No fence is
/// needed (H.-J. Boehm, "Can seqlocks get along with programming language memory models?", MSPC 2012,
/// section 4), and on x86-64 every access is a plain move.
///
/// What holds, on any machine that C++ runs on: a copy that passes is one publication, whole. `newest` never
/// goes back. Versions are stored with release and loaded with acquire, so that a try that fails knows the
/// publication that was in its way: where consecutive cycles are published, `newest` misses only if kReadTries
/// publications overtook it. tests/rt/latest_frames_model_test.cpp visits every execution of a small model of
/// this code that the memory model of C++ allows, and shows that no order and no check can be left out.
///
/// `sequence` counts publications over all writers' lives and is the futex word that readers wait on.
/// Readers need only read access to the memory. After Lookup::kMissing the content of `out` has no meaning.

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "rt/futex.h"
#include "signals/frame_head.h"

namespace robot_control {

inline constexpr std::size_t kFrameSlots = 8;
inline constexpr int kReadTries = 4;

inline constexpr std::uint64_t kChannelMagic = 0x6c74635f746f6272ULL;  // "rbot_ctl"
inline constexpr std::uint64_t kLayoutVersion = 4;

/// First bytes of every shared object: of a LatestFrames as of a Ring. `magic` to `retired` keep their places
/// in every layout version, so that a process can judge and retire an object that it cannot read.
struct ChannelHead {
  std::atomic<std::uint64_t> magic;                 ///< kChannelMagic, stored last when the object is made
  std::uint64_t layout_version;                     ///< kLayoutVersion
  std::uint64_t frame_bytes;                        ///< sizeof(Frame)
  std::uint64_t slots;                              ///< number of frames that fit
  std::atomic<std::uint64_t> retired;               ///< 1: the name now belongs to another object, map again
  std::atomic<std::uint64_t> attached_run;          ///< run whose sensors the writer of this channel waits on
  std::atomic<std::uint64_t> robot_hash;            ///< RobotModel::hash of the writer's robot; sensors channel only
  std::array<std::atomic<char>, 256> robot_source;  ///< where that robot was read, zero-terminated
};

/// Atomic and SlotCount differ from their defaults in the model of the tests alone.
template <class Frame, template <class> class Atomic = std::atomic, std::size_t SlotCount = kFrameSlots>
struct LatestFrames {
  struct Slot {
    Atomic<std::uint64_t> version;
    std::array<Atomic<std::uint64_t>, kFrameWords<Frame>> words;
  };
  ChannelHead head;
  alignas(64) Atomic<std::uint32_t> sequence;  ///< futex word
  Atomic<std::uint64_t> newest;                ///< slot of the last publication + 1; 0 = none
  alignas(64) std::array<Slot, SlotCount> slots;
};
static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

/// Which waiting threads a publication wakes. A loop in one thread, on private memory, saves the system call.
enum class Wake { kReaders, kNobody };

template <class Frame, template <class> class Atomic = std::atomic, std::size_t SlotCount = kFrameSlots>
class FrameWriter {
 public:
  using Frames = LatestFrames<Frame, Atomic, SlotCount>;

  /// `memory`: zeroed, or left by an earlier writer of the same layout. Not owned.
  explicit FrameWriter(Frames* memory = nullptr, Wake wake = Wake::kReaders) noexcept : memory_(memory), wake_(wake) {}

  /// Seals the frame, stores it and wakes all readers. One futex call, nothing else.
  void publish(Frame& frame) noexcept {
    seal(frame);
    publish_sealed(frame);
  }

  /// The same of a frame that is sealed already.
  void publish_sealed(const Frame& frame) noexcept {
    store(frame);
    wake();
  }

  /// Publishes that cycle k has passed here without a frame: a token with the run, cycle and stamp of `head`.
  void publish_token(const FrameHead& head) noexcept {
    Frame token{};
    token.head = {.run = head.run, .cycle = head.cycle, .stamp_ns = head.stamp_ns, .kind = FrameKind::kToken};
    publish(token);
  }

  /// Stores without sealing or waking: for tests that plant a broken frame.
  void store(const Frame& frame) noexcept {
    const std::size_t index = frame.head.cycle % SlotCount;
    auto& slot = memory_->slots[index];
    const std::uint64_t version = slot.version.load(std::memory_order_relaxed) | 1;  // odd also after a crash
    slot.version.store(version, std::memory_order_release);
    for (std::size_t i = 0; i < kFrameWords<Frame>; ++i)
      slot.words[i].store(word_of(frame, i), std::memory_order_release);
    slot.version.store(version + 1, std::memory_order_release);
    memory_->newest.store(index + 1, std::memory_order_release);
  }

  Frames* memory() const noexcept { return memory_; }

 private:
  void wake() noexcept {
    memory_->sequence.fetch_add(1, std::memory_order_release);
    if (wake_ == Wake::kReaders) futex_wake_all(memory_->sequence);
  }

  Frames* memory_;
  Wake wake_;
};

template <class Frame, template <class> class Atomic = std::atomic, std::size_t SlotCount = kFrameSlots>
class FrameReader {
 public:
  using Frames = LatestFrames<Frame, Atomic, SlotCount>;

  explicit FrameReader(const Frames* memory = nullptr) noexcept : memory_(memory) {}
  FrameReader(const FrameReader& other) noexcept : memory_(other.memory_.load()) {}
  FrameReader& operator=(const FrameReader& other) noexcept {
    memory_.store(other.memory_.load());
    return *this;
  }

  /// Ordinary thread: the channel's object was replaced. The old mapping must stay valid.
  void remap(const Frames* memory) noexcept { memory_.store(memory, std::memory_order_release); }

  /// The frame published last.
  Lookup newest(Frame& out) const noexcept {
    const auto* memory = memory_.load(std::memory_order_acquire);
    if (memory == nullptr) return Lookup::kMissing;
    for (int tries = 0; tries < kReadTries; ++tries) {
      const std::uint64_t newest = memory->newest.load(std::memory_order_acquire);
      if (newest == 0 || newest > SlotCount) return Lookup::kMissing;
      if (!copy(memory->slots[newest - 1], out)) continue;
      // A reader that slept in between holds the slot's next frame already: taking it, and then the one
      // before it, would turn time back.
      if (memory->newest.load(std::memory_order_relaxed) == newest) return judge(out);
    }
    return Lookup::kMissing;
  }

  /// What a writer that ended left behind: the frame of the latest stamp among all that are whole, whatever was
  /// published or torn after it. kCorrupt: something was published, and nothing is whole. Not for the loop: reads every
  /// slot.
  Lookup last_whole(Frame& out) const noexcept {
    const auto* memory = memory_.load(std::memory_order_acquire);
    if (memory == nullptr) return Lookup::kMissing;
    bool found = false;
    bool written = memory->newest.load(std::memory_order_acquire) != 0;
    Frame frame;
    for (const auto& slot : memory->slots) {
      if (slot.version.load(std::memory_order_acquire) % 2 != 0) written = true;
      if (!copy(slot, frame) || judge(frame) != Lookup::kFrame) continue;
      if (found && frame.head.stamp_ns < out.head.stamp_ns) continue;
      out = frame;
      found = true;
    }
    if (found) return Lookup::kFrame;
    return written ? Lookup::kCorrupt : Lookup::kMissing;
  }

  /// The frame of this run and cycle.
  Lookup at(std::uint64_t run, std::uint64_t cycle, Frame& out) const noexcept {
    const auto* memory = memory_.load(std::memory_order_acquire);
    if (memory == nullptr) return Lookup::kMissing;
    for (int tries = 0; tries < kReadTries; ++tries) {
      if (!copy(memory->slots[cycle % SlotCount], out)) continue;
      const Lookup found = judge(out);
      if (found == Lookup::kCorrupt) return found;
      return out.head.run == run && out.head.cycle == cycle ? found : Lookup::kMissing;
    }
    return Lookup::kMissing;
  }

  /// The newest frame of cycles first … last of this run (both included), searched downwards, no farther than
  /// frames are kept. A corrupt frame ends the search. A token counts as missing.
  Lookup newest_within(std::uint64_t run, std::uint64_t first, std::uint64_t last, Frame& out) const noexcept {
    std::uint64_t cycle = last;
    for (std::size_t looks = 0; looks < SlotCount && cycle >= first && cycle <= last; ++looks, --cycle) {
      const Lookup found = at(run, cycle, out);
      if (found == Lookup::kFrame || found == Lookup::kCorrupt) return found;
    }
    return Lookup::kMissing;
  }

  std::uint32_t sequence() const noexcept {
    const auto* memory = memory_.load(std::memory_order_acquire);
    return memory == nullptr ? 0 : memory->sequence.load(std::memory_order_acquire);
  }

  /// Waits until `sequence()` differs from `seen`, or the timeout (negative: none) has passed. True if it
  /// differs, or if the channel was mapped or mapped again meanwhile: noticed within kRemapNs, also by a
  /// thread that waits without a timeout. Take `seen` before looking for a frame, not after.
  bool wait(std::uint32_t seen, std::int64_t timeout_ns) const noexcept {
    const auto* memory = memory_.load(std::memory_order_acquire);
    for (std::int64_t left_ns = timeout_ns; left_ns != 0;) {
      const std::int64_t slice_ns = left_ns < 0 || left_ns > kRemapNs ? kRemapNs : left_ns;
      if (memory == nullptr) {
        sleep_ns(slice_ns);
      } else if (futex_wait(memory->sequence, seen, slice_ns)) {
        return true;
      }
      if (memory_.load(std::memory_order_acquire) != memory) return true;
      if (left_ns > 0) left_ns -= slice_ns;
    }
    return memory != nullptr && memory->sequence.load(std::memory_order_acquire) != seen;
  }

  static constexpr std::int64_t kRemapNs = 20'000'000;

  const Frames* memory() const noexcept { return memory_.load(std::memory_order_acquire); }

 private:
  /// False: `out` is not whole.
  static bool copy(const typename Frames::Slot& slot, Frame& out) noexcept {
    const std::uint64_t before = slot.version.load(std::memory_order_acquire);
    if (before % 2 != 0) return false;
    auto* const bytes = reinterpret_cast<std::byte*>(&out);
    for (std::size_t i = 0; i < kFrameWords<Frame>; ++i) {
      const std::uint64_t word = slot.words[i].load(std::memory_order_acquire);
      std::memcpy(bytes + 8 * i, &word, sizeof(word));
    }
    return slot.version.load(std::memory_order_acquire) == before;
  }

  static Lookup judge(const Frame& frame) noexcept {
    if (frame.head.run == 0) return Lookup::kMissing;  // a slot never written
    if (!intact(frame)) return Lookup::kCorrupt;
    if (frame.head.kind == FrameKind::kToken) return Lookup::kToken;
    return frame.head.kind == FrameKind::kFrame ? Lookup::kFrame : Lookup::kCorrupt;
  }

  std::atomic<const Frames*> memory_;
};

}  // namespace robot_control
