#pragma once
/// The entries of a CANopen device, each a number of 1, 2 or 4 bytes, and the SDO server for them (expedited alone).

#include <cstdint>
#include <unordered_map>

#include "drivers/cia402/pdo.h"
#include "drivers/cia402/sdo.h"

namespace robot_control {

class ObjectDictionary {
 public:
  struct Entry {
    std::uint32_t value = 0;
    std::uint8_t bytes = 4;
    bool writable = false;
  };

  void add(const canopen::ObjectAddress& object, std::uint32_t value, std::uint8_t bytes, bool writable) {
    entries_[key(object)] = {.value = value, .bytes = bytes, .writable = writable};
  }
  bool has(const canopen::ObjectAddress& object) const { return entries_.contains(key(object)); }
  void remove(const canopen::ObjectAddress& object) { entries_.erase(key(object)); }

  /// Returns the value, cut to its bytes; 0 for a missing object.
  std::uint32_t value(const canopen::ObjectAddress& object) const;
  /// Returns the value in two's complement of its bytes.
  std::int32_t signed_value(const canopen::ObjectAddress& object) const;
  /// Sets an existing object, whether it is writable or not.
  void set(const canopen::ObjectAddress& object, std::uint32_t value);

  /// Answers a request. `refusal`: abort code of a write that the device refuses for its own reasons; 0: none.
  canopen::SdoMessage answer(const canopen::SdoMessage& request, std::uint32_t refusal);

 private:
  static std::uint32_t key(const canopen::ObjectAddress& object) {
    return static_cast<std::uint32_t>(object.index) << 8U | object.sub;
  }
  std::unordered_map<std::uint32_t, Entry> entries_;
};

}  // namespace robot_control
