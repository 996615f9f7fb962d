#pragma once
/// POSIX shared memory: the object behind a name, its lock, and a mapping of it.
///
/// A name can be unlinked and given to a new object while the old one is still open: after locking an object,
/// call `still_named()`, and start over if it returns false.
/// Failures of the system calls are thrown as std::system_error that names the object.

#include <cstddef>
#include <optional>
#include <string>

namespace robot_control {

enum class Access { kReadOnly, kReadWrite };

/// Memory that stays mapped, and valid, for the life of this value, whatever becomes of the object's name.
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
  /// The object of this name ("/…"); empty where there is none. Does not follow symbolic links and does not block.
  static std::optional<SharedMemory> open(const std::string& name, Access access);

  /// A new object of no size and mode 0600; empty where the name is taken.
  static std::optional<SharedMemory> create(const std::string& name);

  SharedMemory(SharedMemory&& other) noexcept;
  SharedMemory& operator=(SharedMemory&& other) noexcept;
  ~SharedMemory();

  /// A plain object that belongs to this process's effective user, and is accessible to that user only (an access list
  /// that lets in others shows in the mode's group bits).
  bool is_private() const;

  std::size_t bytes() const;

  /// Sizes the object and reserves its pages: a later write cannot fail for want of memory.
  void reserve(std::size_t bytes);

  /// Maps the first `bytes`, page tables filled. Refused (std::system_error, EINVAL) where the object is
  /// shorter: a touch behind its end would be a SIGBUS.
  MemoryMapping map(std::size_t bytes) const;

  /// Copies out of and into the object without mapping it; false where the object ends before.
  bool read_at(std::size_t offset, void* to, std::size_t bytes) const noexcept;
  bool write_at(std::size_t offset, const void* from, std::size_t bytes) const noexcept;

  /// The open-file-description write lock on the whole object: held until this value and every copy of the
  /// descriptor in forked children are gone, so it ends with the process however that ends. False: taken.
  bool lock() noexcept;

  /// True while another open file description holds it. A read-only descriptor may ask.
  bool locked_elsewhere() const noexcept;

  /// The name still belongs to this object.
  bool still_named() const;
  bool same_object(const SharedMemory& other) const;

 private:
  SharedMemory(std::string name, int descriptor, Access access) noexcept;

  std::string name_;
  int descriptor_ = -1;
  Access access_ = Access::kReadOnly;
};

}  // namespace robot_control
