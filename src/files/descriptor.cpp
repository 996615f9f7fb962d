#include "files/descriptor.h"

#include <sys/stat.h>

#include <cerrno>

namespace robot_control {

int Descriptor::write(std::string_view bytes, std::optional<off_t> at) const noexcept {
  while (!bytes.empty()) {
    const ssize_t taken =
        at ? ::pwrite(number_, bytes.data(), bytes.size(), *at) : ::write(number_, bytes.data(), bytes.size());
    if (taken < 0 && errno == EINTR) continue;
    if (taken <= 0) return taken < 0 ? errno : EIO;
    bytes.remove_prefix(static_cast<std::size_t>(taken));
    if (at) *at += taken;
  }
  return 0;
}

int Descriptor::absence_from(const std::string& path) const noexcept {
  struct stat own {};
  struct stat present {};
  if (::fstat(number_, &own) != 0 || ::stat(path.c_str(), &present) != 0) return errno;
  return present.st_ino == own.st_ino && present.st_dev == own.st_dev ? 0 : ENOENT;
}

}  // namespace robot_control
