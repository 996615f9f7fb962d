#pragma once
/// The channels between processes: one POSIX shared-memory object each,
/// `/robot_control.<uid>.<bus>.<channel>`, mode 0600.
///
/// A writer holds an open-file-description lock on its object for as long as it lives: a second instance of a
/// node refuses to start. The object outlives its writer; the next one of the same layout takes it over with
/// its frames and its futex sequence, an unlocked object of another layout is retired and made anew, a locked
/// one is an error. Foreign (other owner, other magic) and truncated objects are never written to.

#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "rt/latest_frames.h"
#include "rt/ring.h"

namespace robot_control {

/// What (channel, object), why, remedy.
class BusError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// `name` of the bus: the parameter `bus`, or 16 hex digits of a hash of ROS master port and namespace.
std::string bus_name(const std::string& master_uri, const std::string& name_space);

struct ChannelNames {
  static constexpr const char* kSensors = "sensors";
  static constexpr const char* kState = "state";
  static constexpr const char* kCommand = "command";
  static constexpr const char* kPermit = "permit";
  static constexpr const char* kTruth = "truth";
  static constexpr const char* kTraceRead = "trace_read";
  // rings: "trace_plant" "trace_estimator" "trace_controller" "trace_monitor"
};

/// A channel that this process writes: the mapping and its lock.
template <class Object>
class OwnedChannel {
 public:
  /// Object is LatestFrames<Frame>, Ring<Row> or RingPositions. Throws BusError.
  OwnedChannel(const std::string& bus, const std::string& channel);
  Object* memory() const noexcept;
};

/// A channel that another process writes. Before its writer has made it, `memory()` is null.
template <class Object>
class ForeignChannel {
 public:
  ForeignChannel(std::string bus, std::string channel);

  /// Ordinary thread, at 10 Hz: maps, or maps anew after retirement or unlink. True if `memory()` changed.
  /// Throws BusError on a foreign or truncated object of this name. Old mappings stay valid.
  bool poll();

  /// True while some process holds the writer's lock.
  bool locked() const;

  const Object* memory() const noexcept;
};

}  // namespace robot_control
