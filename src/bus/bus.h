#pragma once
/// The channels between processes: one POSIX shared-memory object each,
/// `/robot_control.<uid>.<bus>.<channel>`, mode 0600.
///
/// A writer holds an open-file-description lock on its object for as long as it lives, and a second instance of
/// a node refuses to start. The object outlives its writer. The next writer finds
///   the same layout, unlocked     takes it over with its frames and its futex sequence
///   another layout, unlocked      retires it (ChannelHead::retired) and makes a new one; the futex sequence of
///                                 a new object begins at a random number
///   truncated or foreign magic    never writes to it, unlinks it and makes a new one
///   any of them, locked           BusError after a third of a second: another instance, or a node of another build, is
///                                 running
///   another owner, open to others BusError naming owner or mode; its mode is not corrected, because another
///                                 process may still have it open
///   a link, directory, pipe       BusError
/// The next start of any node removes the objects that processes of another bus left (bus_cleanup.h).
/// A reader maps read-only, and only usable objects. It waits for an unusable object that is not locked, because the
/// next writer replaces it. A locked one and a foreign owner are a BusError. A lock does not outlive the process
/// that took it, unless a forked child has kept the descriptor.

#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <utility>

#include "bus/bus_object.h"
#include "bus/latest_frames.h"
#include "bus/ring.h"

namespace robot_control {

/// `name` of the bus if the parameter `bus` is empty: 16 hex digits of a 64-bit FNV-1a hash. It covers the port of the
/// ROS master (11311 where the URI has none) and the namespace ("robot2", "/robot2" and "/robot2/" are one).
std::string bus_name(const std::string& master_uri, const std::string& name_space);

struct ChannelNames {
  static constexpr const char* kSensors = "sensors";
  static constexpr const char* kState = "state";
  static constexpr const char* kCommand = "command";
  static constexpr const char* kPermit = "permit";
  static constexpr const char* kTruth = "truth";
  static constexpr const char* kTraceRead = "trace_read";
  // rings: "trace_" and "snapshot_" "plant", "estimator", "controller", "monitor"
};

/// Channel of each ring, by TraceRing.
inline constexpr const char* kTraceChannels[kTraceRings] = {"trace_plant", "trace_estimator", "trace_controller",
                                                            "trace_monitor"};

/// The layout of LatestFrames<Frame>, Ring<Row>, RingPositions.
template <class Object>
struct BusLayoutOf;

template <class Frame>
struct BusLayoutOf<LatestFrames<Frame>> {
  static constexpr BusLayout value{sizeof(LatestFrames<Frame>), sizeof(Frame), kFrameSlots};
};

template <class Row, std::size_t Rows>
struct BusLayoutOf<Ring<Row, std::atomic, Rows>> {
  static constexpr BusLayout value{sizeof(Ring<Row, std::atomic, Rows>), sizeof(Row), Rows};
};

template <>
struct BusLayoutOf<RingPositions> {
  static constexpr BusLayout value{sizeof(RingPositions), sizeof(std::uint64_t), kTraceRings};
};

/// A channel that this process writes: the mapping and its lock.
template <class Object>
class OwnedChannel {
 public:
  /// Object is LatestFrames<Frame>, Ring<Row> or RingPositions. Throws BusError. The writer's own entries in the
  /// head (run attached to, robot) restart.
  OwnedChannel(const std::string& bus, const std::string& channel)
      : object_(OwnedBusObject::claim(bus, channel, BusLayoutOf<Object>::value)) {
    // A reader of the retired object may come with a sequence seen there; equal numbers would let it sleep.
    if constexpr (requires { memory()->sequence; }) {
      if (object_.is_new()) memory()->sequence.store(std::random_device{}(), std::memory_order_release);
    }
  }

  Object* memory() const noexcept { return static_cast<Object*>(object_.data()); }

 private:
  OwnedBusObject object_;
};

/// A channel that another process writes. Before its writer has made it, `memory()` is null. `memory` may be
/// called by any thread, the rest by one ordinary thread.
template <class Object>
class ForeignChannel {
 public:
  ForeignChannel(std::string bus, std::string channel)
      : object_(std::make_unique<ForeignBusObject>(bus, std::move(channel), BusLayoutOf<Object>::value)) {}

  /// Ordinary thread, at 10 Hz: maps, or maps again when the name has a new object. True if `memory()` changed.
  /// Throws BusError. A shortage of descriptors is temporary: mappings stay, and the next poll tries again. Old
  /// mappings stay valid. After an unlink without a successor the old one stays current, because its writer may
  /// continue.
  bool poll() { return object_->poll(); }

  /// True while some process holds the writer's lock on the mapped object; false while none is mapped.
  bool locked() const { return object_->locked(); }

  const Object* memory() const noexcept { return static_cast<const Object*>(object_->data()); }

  /// Why the last `poll` did not map the object of this name ("does not exist yet"); empty when it is mapped.
  const std::string& obstacle() const noexcept { return object_->obstacle(); }

 private:
  std::unique_ptr<ForeignBusObject> object_;
};

/// A consumer publishes in its own channel which run's sensors it waits on. Real-time safe.
inline void attach_to_run(ChannelHead& own, std::uint64_t run) noexcept {
  own.attached_run.store(run, std::memory_order_release);
}

/// 0: to none.
inline std::uint64_t attached_run(const ChannelHead& head) noexcept {
  return head.attached_run.load(std::memory_order_acquire);
}

/// The driver publishes in the sensors channel which robot it drives: MachineModel::hash and ::source (cut at 255
/// bytes). Ordinary thread, before the first frame.
void announce_robot(ChannelHead& own, std::uint64_t hash, const std::string& source) noexcept;

struct AnnouncedRobot {
  std::uint64_t hash = 0;
  std::string source;
};

/// Hash 0: nothing was announced yet.
AnnouncedRobot announced_robot(const ChannelHead& head);

/// False while nothing was announced; throws BusError, naming both sources, if it is another robot.
bool same_robot(const ChannelHead& sensors, std::uint64_t hash, const std::string& source);

}  // namespace robot_control
