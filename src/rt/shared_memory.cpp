#include "rt/shared_memory.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

namespace robot_control {
namespace {

[[noreturn]] void fail(int error, const std::string& call, const std::string& name) {
  throw std::system_error(error, std::generic_category(), call + " " + name);
}

struct stat status_of(int descriptor, const std::string& name) {
  struct stat status {};
  if (fstat(descriptor, &status) != 0) fail(errno, "fstat", name);
  return status;
}

struct flock whole_object(short type) noexcept {
  struct flock range {};
  range.l_type = type;
  range.l_whence = SEEK_SET;
  return range;  // start 0 and length 0 mean the whole object, also after it grows
}

}  // namespace

MemoryMapping::MemoryMapping(MemoryMapping&& other) noexcept
    : data_(std::exchange(other.data_, nullptr)), bytes_(std::exchange(other.bytes_, 0)) {}

MemoryMapping& MemoryMapping::operator=(MemoryMapping&& other) noexcept {
  std::swap(data_, other.data_);
  std::swap(bytes_, other.bytes_);
  return *this;
}

MemoryMapping::~MemoryMapping() {
  if (data_ != nullptr) munmap(data_, bytes_);
}

SharedMemory::SharedMemory(std::string name, int descriptor, Access access) noexcept
    : name_(std::move(name)), descriptor_(descriptor), access_(access) {}

SharedMemory::SharedMemory(SharedMemory&& other) noexcept
    : name_(std::move(other.name_)), descriptor_(std::exchange(other.descriptor_, -1)), access_(other.access_) {}

SharedMemory& SharedMemory::operator=(SharedMemory&& other) noexcept {
  std::swap(name_, other.name_);
  std::swap(descriptor_, other.descriptor_);
  std::swap(access_, other.access_);
  return *this;
}

SharedMemory::~SharedMemory() {
  if (descriptor_ >= 0) close(descriptor_);
}

std::optional<SharedMemory> SharedMemory::open(const std::string& name, Access access) {
  const int mode = access == Access::kReadOnly ? O_RDONLY : O_RDWR;
  const int descriptor =
      shm_open(name.c_str(), mode | O_NONBLOCK, 0);  // otherwise opening a pipe of this name would block for ever
  if (descriptor >= 0) return SharedMemory(name, descriptor, access);
  if (errno != ENOENT) fail(errno, "shm_open", name);
  return std::nullopt;
}

std::optional<SharedMemory> SharedMemory::create(const std::string& name) {
  const int descriptor = shm_open(name.c_str(), O_RDWR | O_CREAT | O_EXCL, S_IRUSR | S_IWUSR);
  if (descriptor < 0) {
    if (errno != EEXIST) fail(errno, "shm_open", name);
    return std::nullopt;
  }
  SharedMemory made(name, descriptor, Access::kReadWrite);
  if (fchmod(descriptor, S_IRUSR | S_IWUSR) != 0) fail(errno, "fchmod", name);  // a strict umask may have removed bits
  return made;
}

bool SharedMemory::is_private() const {
  const struct stat status = status_of(descriptor_, name_);
  return S_ISREG(status.st_mode) && status.st_uid == geteuid() && (status.st_mode & (S_IRWXG | S_IRWXO)) == 0;
}

std::size_t SharedMemory::bytes() const {
  return static_cast<std::size_t>(status_of(descriptor_, name_).st_size);
}

void SharedMemory::reserve(std::size_t bytes) {
  int error = EINTR;
  while (error == EINTR) error = posix_fallocate(descriptor_, 0, static_cast<off_t>(bytes));
  if (error != 0) fail(error, "posix_fallocate", name_);
}

MemoryMapping SharedMemory::map(std::size_t bytes) const {
  if (this->bytes() < bytes) fail(EINVAL, "mmap beyond the end of", name_);
  const int protection = access_ == Access::kReadOnly ? PROT_READ : PROT_READ | PROT_WRITE;
  void* data = mmap(nullptr, bytes, protection, MAP_SHARED | MAP_POPULATE, descriptor_, 0);
  if (data == MAP_FAILED) fail(errno, "mmap", name_);
  return {data, bytes};
}

bool SharedMemory::read_at(std::size_t offset, void* to, std::size_t bytes) const noexcept {
  return pread(descriptor_, to, bytes, static_cast<off_t>(offset)) == static_cast<ssize_t>(bytes);
}

bool SharedMemory::write_at(std::size_t offset, const void* from, std::size_t bytes) const noexcept {
  return pwrite(descriptor_, from, bytes, static_cast<off_t>(offset)) == static_cast<ssize_t>(bytes);
}

bool SharedMemory::lock() noexcept {
  struct flock range = whole_object(F_WRLCK);
  return fcntl(descriptor_, F_OFD_SETLK, &range) == 0;
}

bool SharedMemory::locked_elsewhere() const noexcept {
  struct flock range = whole_object(F_RDLCK);  // conflicts only with a write lock
  return fcntl(descriptor_, F_OFD_GETLK, &range) == 0 && range.l_type != F_UNLCK;
}

bool SharedMemory::still_named() const {
  const std::optional<SharedMemory> named = open(name_, Access::kReadOnly);
  return named && same_object(*named);
}

bool SharedMemory::same_object(const SharedMemory& other) const {
  const struct stat mine = status_of(descriptor_, name_);
  const struct stat theirs = status_of(other.descriptor_, other.name_);
  return mine.st_dev == theirs.st_dev && mine.st_ino == theirs.st_ino;
}

}  // namespace robot_control
