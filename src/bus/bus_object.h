#pragma once
/// The part of a channel that is the same for any type: the claim of an object by its writer, the view of a reader.
/// The protocol: bus/bus.h.

#include <atomic>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bus/latest_frames.h"
#include "rt/shared_memory.h"

namespace robot_control {

/// The message names the channel or object, the reason and the remedy.
class BusError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The required content of the head of a channel's object, and the object's length.
struct BusLayout {
  std::uint64_t object_bytes = 0;
  std::uint64_t frame_bytes = 0;
  std::uint64_t slots = 0;
};

/// "/robot_control.<uid>.<bus>.<channel>". Throws BusError: a part is empty, has a character other than
/// letters, digits, '_', '-', '.', or the whole is longer than a file name may be.
std::string bus_object_name(const std::string& bus, const std::string& channel);

/// The content of an object for a process that expects `layout`.
enum class BusContent { kUsable, kNone, kUnreadable };
BusContent content_of(const SharedMemory& object, const BusLayout& layout);

class OwnedBusObject {
 public:
  /// Throws BusError.
  static OwnedBusObject claim(const std::string& bus, const std::string& channel, const BusLayout& layout);

  OwnedBusObject(SharedMemory object, MemoryMapping mapping, bool is_new) noexcept
      : object_(std::move(object)), mapping_(std::move(mapping)), is_new_(is_new) {}

  void* data() const noexcept { return mapping_.data(); }

  /// Made by this process; otherwise taken over.
  bool is_new() const noexcept { return is_new_; }

 private:
  SharedMemory object_;
  MemoryMapping mapping_;
  bool is_new_ = false;
};

class ForeignBusObject {
 public:
  ForeignBusObject(const std::string& bus, std::string channel, const BusLayout& layout);

  bool poll();
  bool locked() const noexcept { return object_ && object_->locked_elsewhere(); }
  const void* data() const noexcept { return data_.load(std::memory_order_acquire); }
  const std::string& obstacle() const noexcept { return obstacle_; }

 private:
  bool map_newest();
  bool is_current(const SharedMemory& named) const;
  std::string obstacle_of(const SharedMemory& named) const;

  std::string channel_;
  std::string name_;
  BusLayout layout_;
  std::optional<SharedMemory> object_;
  std::vector<MemoryMapping> mappings_;  // all of this life: a real-time thread may still read an old one
  std::atomic<const void*> data_{nullptr};
  std::string obstacle_;
};

}  // namespace robot_control
