#pragma once
/// LatestFrames holds the latest frames of one channel, with one writer and any number of readers in any process.
///
/// There are eight slots; the frame of cycle c is in slot c mod 8. The writer is wait-free, a reader copies and retries
/// at most kReadTries times. Each slot is a sequence lock whose words are atomics. The writer stores an odd version,
/// then every word with release, then the even version. A reader that loads one new word with acquire therefore sees
/// the odd version afterwards and discards its copy. No fence is needed (H.-J. Boehm, "Can seqlocks get along with
/// programming language memory models?", MSPC 2012, section 4). On x86-64 every access is a plain move.
///
/// The memory model of C++ guarantees: an accepted copy is one complete publication, and `newest` never returns an
/// older frame than before. Versions are stored with release and loaded with acquire, so that after a failed try the
/// next one sees the publication that disturbed it. With consecutive cycles `newest` therefore misses only if
/// kReadTries publications overtook it. The test tests/bus/latest_frames_model_test.cpp visits every execution that C++
/// allows of a small model of this code. It shows that no memory order and no check can be left out.
///
/// `sequence` counts the publications of all successive writers, and readers wait on it as futex word. Readers need
/// only read access to the memory. After Lookup::kMissing the content of `out` has no meaning.

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
inline constexpr std::uint64_t kLayoutVersion = 5;

/// The first bytes of every shared object, LatestFrames or Ring. `magic` to `retired` have the same place in every
/// layout version, so that a process can check and retire an object that it cannot read.
struct ChannelHead {
  std::atomic<std::uint64_t> magic;         ///< kChannelMagic, stored last when the object is made
  std::uint64_t layout_version;             ///< kLayoutVersion
  std::uint64_t frame_bytes;                ///< sizeof(Frame)
  std::uint64_t slots;                      ///< number of slots for frames
  std::atomic<std::uint64_t> retired;       ///< 1: the name belongs to another object now, which must be mapped
  std::atomic<std::uint64_t> attached_run;  ///< run whose sensors the writer of this channel waits on
  std::atomic<std::uint64_t> robot_hash;  ///< of the writer's robot: MachineModel::hash (sensors), stop_owner (permit)
  std::array<std::atomic<char>, 256> robot_source;  ///< file of that robot, zero-terminated
};

/// Atomic and SlotCount have other values than their defaults only in the tests' model.
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

/// The frames of a channel that one thread writes and reads: they are neither copied nor checked, because nothing can
/// tear them. They have checksums only if `sealed`. A frame that was stored by `store` is a copy and checked.
///
/// A frame that was published in place is missing when `kept` later ones were: the fewer, the less memory a cycle
/// passes through.
template <class Frame, std::size_t SlotCount = kFrameSlots>
struct OwnFrames {
  struct Slot {
    Slot() = default;
    Slot(const Slot& other) : stored(*other.frame), whole(other.whole) {}
    Slot& operator=(const Slot&) = delete;

    Frame stored{};
    Frame* frame = &stored;  ///< where the writer has put it, or `stored`
    bool whole = false;      ///< its writer has published it by `publish`
  };

  /// From now on frames have checksums, those that are here, too.
  void seal_all() noexcept {
    for (Slot& slot : slots) {
      if (slot.whole && !sealed) seal(*slot.frame);
    }
    sealed = true;
  }

  std::array<Slot, SlotCount> slots;
  bool sealed = false;
  std::size_t kept = SlotCount;  ///< frames that their writer leaves where they are, 1 … SlotCount
};

/// The result of a lookup without a copy. The frame is in the buffer of the caller, or where its writer has put it;
/// there it stays for OwnFrames::kept cycles.
template <class Frame>
struct Found {
  Lookup lookup = Lookup::kMissing;
  const Frame* frame = nullptr;  ///< never null; without meaning after kMissing
};

/// The waiting threads that a publication wakes. A loop in one thread on private memory avoids the system call.
enum class Wake { kReaders, kNone };

template <class Frame, template <class> class Atomic = std::atomic, std::size_t SlotCount = kFrameSlots>
class FrameReader;

template <class Frame, template <class> class Atomic = std::atomic, std::size_t SlotCount = kFrameSlots>
class FrameWriter {
 public:
  using Frames = LatestFrames<Frame, Atomic, SlotCount>;

  /// `memory` is zeroed or was left by an earlier writer of the same layout. It is not owned.
  explicit FrameWriter(Frames* memory = nullptr, Wake wake = Wake::kReaders) noexcept : memory_(memory), wake_(wake) {}

  /// Writes for readers in the same thread.
  FrameWriter(Frames* memory, OwnFrames<Frame, SlotCount>* own) noexcept : memory_(memory), own_(own) {}

  /// Seals the frame, stores it and wakes all readers with one futex call.
  void publish(Frame& frame) noexcept {
    if (seals()) seal(frame);
    publish_sealed(frame);
    if (own_ != nullptr) own_->slots[frame.head.cycle % SlotCount].whole = true;
  }

  /// Publishes a frame that stays where it is for `kept` cycles. A reader in the same thread finds it there.
  void publish_in_place(Frame& frame) noexcept {
    if (own_ == nullptr) return publish(frame);
    if (own_->sealed) seal(frame);
    const std::size_t index = frame.head.cycle % SlotCount;
    own_->slots[index].frame = &frame;
    own_->slots[index].whole = true;
    memory_->newest.store(index + 1, std::memory_order_relaxed);
  }

  /// Returns whether frames are published with a checksum.
  bool seals() const noexcept { return own_ == nullptr || own_->sealed; }

  /// Returns how many frames a writer must keep for `publish_in_place`.
  std::size_t kept() const noexcept { return own_ == nullptr ? 1 : own_->kept; }

  /// Publishes a frame that is already sealed.
  void publish_sealed(const Frame& frame) noexcept {
    store(frame);
    wake();
  }

  /// Publishes a token with run, cycle and stamp of `head`: this cycle has passed without a frame.
  void publish_token(const FrameHead& head) noexcept {
    Frame token{};
    token.head = {.run = head.run, .cycle = head.cycle, .stamp_ns = head.stamp_ns, .kind = FrameKind::kToken};
    publish(token);
  }

  /// Stores a frame without sealing it or waking readers, for tests with a broken frame.
  void store(const Frame& frame) noexcept {
    const std::size_t index = frame.head.cycle % SlotCount;
    if (own_ != nullptr) {
      auto& slot = own_->slots[index];
      slot.stored = frame;
      slot.frame = &slot.stored;
      slot.whole = false;
      memory_->newest.store(index + 1, std::memory_order_relaxed);
      return;
    }
    auto& slot = memory_->slots[index];
    const std::uint64_t version = slot.version.load(std::memory_order_relaxed) | 1;  // odd also after a crash
    slot.version.store(version, std::memory_order_release);
    for (std::size_t i = 0; i < kFrameWords<Frame>; ++i)
      slot.words[i].store(word_of(frame, i), std::memory_order_release);
    slot.version.store(version + 1, std::memory_order_release);
    memory_->newest.store(index + 1, std::memory_order_release);
  }

  Frames* memory() const noexcept { return memory_; }

  /// Returns a reader of this channel.
  auto reader() const noexcept { return FrameReader<Frame, Atomic, SlotCount>(memory_, own_); }

 private:
  void wake() noexcept {
    if (own_ != nullptr) return;
    memory_->sequence.fetch_add(1, std::memory_order_release);
    if (wake_ == Wake::kReaders) futex_wake_all(memory_->sequence);
  }

  Frames* memory_;
  Wake wake_ = Wake::kNone;
  OwnFrames<Frame, SlotCount>* own_ = nullptr;
};

template <class Frame, template <class> class Atomic, std::size_t SlotCount>
class FrameReader {
 public:
  using Frames = LatestFrames<Frame, Atomic, SlotCount>;

  explicit FrameReader(const Frames* memory = nullptr) noexcept : memory_(memory) {}

  /// Reads what a writer in the same thread puts into `own`.
  FrameReader(const Frames* memory, const OwnFrames<Frame, SlotCount>* own) noexcept : memory_(memory), own_(own) {}
  FrameReader(const FrameReader& other) noexcept : memory_(other.memory_.load()), own_(other.own_) {}
  FrameReader& operator=(const FrameReader& other) noexcept {
    memory_.store(other.memory_.load());
    own_ = other.own_;
    return *this;
  }

  /// Maps the object that replaced the channel's; an ordinary thread calls it. The old mapping must stay valid.
  void remap(const Frames* memory) noexcept { memory_.store(memory, std::memory_order_release); }

  /// These three are `newest`, `at` and `newest_within` without a copy, if the channel is that of one thread.
  Found<Frame> find_newest(Frame& buffer) const noexcept {
    if (own_ == nullptr) return {newest(buffer), &buffer};
    const std::uint64_t newest = memory_.load(std::memory_order_relaxed)->newest.load(std::memory_order_relaxed);
    return newest == 0 ? Found<Frame>{Lookup::kMissing, &buffer} : found_in(own_->slots[newest - 1]);
  }
  Found<Frame> find_at(std::uint64_t run, std::uint64_t cycle, Frame& buffer) const noexcept {
    if (own_ == nullptr) return {at(run, cycle, buffer), &buffer};
    const Found<Frame> found = found_in(own_->slots[cycle % SlotCount]);
    const FrameHead& head = found.frame->head;
    if (found.lookup == Lookup::kCorrupt || (head.run == run && head.cycle == cycle)) return found;
    return {Lookup::kMissing, found.frame};
  }
  Found<Frame> find_within(std::uint64_t run, std::uint64_t first, std::uint64_t last, Frame& buffer) const noexcept {
    std::uint64_t cycle = last;
    for (std::size_t looks = 0; looks < SlotCount && cycle >= first && cycle <= last; ++looks, --cycle) {
      const Found<Frame> found = find_at(run, cycle, buffer);
      if (found.lookup == Lookup::kFrame || found.lookup == Lookup::kCorrupt) return found;
    }
    return {Lookup::kMissing, &buffer};
  }

  /// Reads the last published frame.
  Lookup newest(Frame& out) const noexcept {
    if (own_ != nullptr) return copied(find_newest(out), out);
    const auto* memory = memory_.load(std::memory_order_acquire);
    if (memory == nullptr) return Lookup::kMissing;
    for (int tries = 0; tries < kReadTries; ++tries) {
      const std::uint64_t newest = memory->newest.load(std::memory_order_acquire);
      if (newest == 0 || newest > SlotCount) return Lookup::kMissing;
      if (!copy(memory->slots[newest - 1], out)) continue;
      // A reader that slept meanwhile has copied the slot's next frame. A later call could then return the frame before
      // it, and time would go backwards.
      if (memory->newest.load(std::memory_order_relaxed) == newest) return classify(out);
    }
    return Lookup::kMissing;
  }

  /// Reads the last frame that an ended writer left. If that frame is torn or a token, reads the complete one with the
  /// latest stamp. Returns kCorrupt if frames were published but none is complete. It reads every slot and is not meant
  /// for the loop.
  Lookup last_whole(Frame& out) const noexcept {
    if (newest(out) == Lookup::kFrame) return Lookup::kFrame;
    const auto* memory = memory_.load(std::memory_order_acquire);
    if (memory == nullptr) return Lookup::kMissing;
    bool found = false;
    bool written = memory->newest.load(std::memory_order_acquire) != 0;
    Frame frame;
    for (const auto& slot : memory->slots) {
      if (slot.version.load(std::memory_order_acquire) % 2 != 0) written = true;
      if (!copy(slot, frame) || classify(frame) != Lookup::kFrame) continue;
      if (found && frame.head.stamp_ns < out.head.stamp_ns) continue;
      out = frame;
      found = true;
    }
    if (found) return Lookup::kFrame;
    return written ? Lookup::kCorrupt : Lookup::kMissing;
  }

  /// Reads the frame of this run and cycle.
  Lookup at(std::uint64_t run, std::uint64_t cycle, Frame& out) const noexcept {
    if (own_ != nullptr) return copied(find_at(run, cycle, out), out);
    const auto* memory = memory_.load(std::memory_order_acquire);
    if (memory == nullptr) return Lookup::kMissing;
    for (int tries = 0; tries < kReadTries; ++tries) {
      if (!copy(memory->slots[cycle % SlotCount], out)) continue;
      const Lookup found = classify(out);
      if (found == Lookup::kCorrupt) return found;
      return out.head.run == run && out.head.cycle == cycle ? found : Lookup::kMissing;
    }
    return Lookup::kMissing;
  }

  /// Reads the newest frame of cycles first … last of this run (both included). It searches downwards as far as frames
  /// are kept. A corrupt frame ends the search. A token counts as missing.
  Lookup newest_within(std::uint64_t run, std::uint64_t first, std::uint64_t last, Frame& out) const noexcept {
    return copied(find_within(run, first, last, out), out);
  }

  std::uint32_t sequence() const noexcept {
    const auto* memory = memory_.load(std::memory_order_acquire);
    return memory == nullptr ? 0 : memory->sequence.load(std::memory_order_acquire);
  }

  /// Waits until `sequence()` differs from `seen`, or the timeout (negative: none) has passed. Returns true if it
  /// differs, or if the channel was mapped meanwhile. A mapping is noticed within kRemapNs, also without a timeout. The
  /// caller reads `seen` before it looks up a frame, not after.
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
  static Found<Frame> found_in(const typename OwnFrames<Frame, SlotCount>::Slot& slot) noexcept {
    return {slot.whole ? kind_of(*slot.frame) : classify(*slot.frame), slot.frame};
  }

  static Lookup copied(const Found<Frame>& found, Frame& out) noexcept {
    if (found.frame != &out) out = *found.frame;
    return found.lookup;
  }

  /// Returns false if `out` is not one complete publication.
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

  static Lookup classify(const Frame& frame) noexcept {
    if (frame.head.run == 0) return Lookup::kMissing;  // the slot was never written
    return intact(frame) ? kind_of(frame) : Lookup::kCorrupt;
  }

  static Lookup kind_of(const Frame& frame) noexcept {
    if (frame.head.kind == FrameKind::kToken) return Lookup::kToken;
    return frame.head.kind == FrameKind::kFrame ? Lookup::kFrame : Lookup::kCorrupt;
  }

  std::atomic<const Frames*> memory_;
  const OwnFrames<Frame, SlotCount>* own_ = nullptr;
};

}  // namespace robot_control
