#pragma once
/// SharedMemory is a POSIX shared-memory object with its name and its lock; MemoryMapping is a mapping of it.
///
/// A name can be unlinked and given to a new object while the old one is still open. After locking an object the caller
/// therefore checks `still_named()` and starts over if it returns false. Failures of system calls are thrown as
/// std::system_error, which names the object.

#include <cstddef>
#include <optional>
#include <string>

namespace robot_control {

enum class Access { kReadOnly, kReadWrite };

/// Memory that stays mapped and valid while this value lives, also after the object's name is removed.
class MemoryMapping {
 public:
  MemoryMapping() noexcept = default;
  MemoryMapping(void* data, std::size_t bytes) noexcept : data_(data), bytes_(bytes) {}
  MemoryMapping(MemoryMapping&& other) noexcept;
  MemoryMapping& operator=(MemoryMapping&& other) noexcept;
  ~MemoryMapping();

  void* data() const noexcept { return data_; }

 private:
  void* data_ = nullptr;
  std::size_t bytes_ = 0;
};

class SharedMemory {
 public:
  /// Opens the object of this name ("/…"); returns nothing if there is none. It does not follow symbolic links and does
  /// not block.
  static std::optional<SharedMemory> open(const std::string& name, Access access);

  /// Creates an object of size 0 and mode 0600; returns nothing if the name is in use.
  static std::optional<SharedMemory> create(const std::string& name);

  SharedMemory(SharedMemory&& other) noexcept;
  SharedMemory& operator=(SharedMemory&& other) noexcept;
  ~SharedMemory();

  /// Returns whether the object is a regular one that belongs to this process's effective user, and only that user has
  /// access. An access list for other users would appear in the mode's group bits.
  bool is_private() const;

  std::size_t bytes() const;

  /// Sets the size of the object and reserves its pages, so that no later write fails because memory ran out.
  void reserve(std::size_t bytes);

  /// Maps the first `bytes` and fills the page tables. Throws std::system_error (EINVAL) if the object is shorter,
  /// because an access behind its end would cause SIGBUS.
  MemoryMapping map(std::size_t bytes) const;

  /// Copy from and to the object without mapping it. Return false if the object ends before.
  bool read_at(std::size_t offset, void* to, std::size_t bytes) const noexcept;
  bool write_at(std::size_t offset, const void* from, std::size_t bytes) const noexcept;

  /// Takes the open-file-description write lock on the whole object. The lock is held until this value and all copies
  /// of the descriptor in forked children are closed. The end of the process always releases it. Returns false if
  /// another one holds the lock.
  bool lock() noexcept;

  /// Returns whether another open file description holds the lock. A read-only descriptor suffices.
  bool locked_elsewhere() const noexcept;

  /// Returns whether the name still belongs to this object.
  bool still_named() const;
  bool same_object(const SharedMemory& other) const;

 private:
  SharedMemory(std::string name, int descriptor, Access access) noexcept;

  std::string name_;
  int descriptor_ = -1;
  Access access_ = Access::kReadOnly;
};

}  // namespace robot_control
