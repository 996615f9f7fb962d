#include "files/output_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

#include "files/descriptor.h"

namespace robot_control {
namespace {

namespace fs = std::filesystem;

constexpr mode_t kNewFile = 0644;  // minus the bits of the umask

class OutputDescriptor {
 public:
  OutputDescriptor(std::string path, int flags)
      : path_(std::move(path)), file_(open(path_.c_str(), flags | O_CLOEXEC | O_NOCTTY, kNewFile)) {
    if (!file_.open()) fail();
  }

  void write_all(const std::string& text) const {
    if (file_.write(text) != 0) fail();
  }

  void sync() const {
    // Pipes and devices have nothing to synchronise.
    if (fsync(file_.number()) != 0 && errno != EINVAL && errno != EROFS) fail();
  }

  void close() {
    if (file_.close() != 0) fail();
  }

  /// Returns false if this user may not change the owner.
  bool copy_owner_and_mode(const struct stat& old) const {
    struct stat own {};
    if (fstat(file_.number(), &own) != 0) fail();
    const bool other = own.st_uid != old.st_uid || own.st_gid != old.st_gid;
    if (other && fchown(file_.number(), old.st_uid, old.st_gid) != 0) return false;
    if (fchmod(file_.number(), old.st_mode & 07777U) != 0) fail();
    return true;
  }

 private:
  [[noreturn]] void fail() const { throw std::system_error(errno, std::generic_category(), path_); }

  std::string path_;
  Descriptor file_;
};

/// Returns the target of symbolic links, which need not exist.
fs::path behind_links(fs::path path) {
  constexpr int kMaxLinks = 40;  // as the kernel
  for (int links = 0; links < kMaxLinks; ++links) {
    std::error_code error;
    if (!fs::is_symlink(fs::symlink_status(path, error))) return path;
    const fs::path target = fs::read_symlink(path);
    path = target.is_absolute() ? target : path.parent_path() / target;
  }
  throw std::system_error(ELOOP, std::generic_category(), path.string());
}

void write_in_place(const std::string& path, const std::string& text, int flags) {
  OutputDescriptor file(path, O_WRONLY | flags);
  file.write_all(text);
  file.sync();
  file.close();
}

/// Returns false, and changes nothing, if the owner of the old file cannot be kept.
bool replace(const fs::path& path, const struct stat* old, const std::string& text) {
  const std::string fresh = path.string() + ".new";
  unlink(fresh.c_str());  // left by a process that was killed
  try {
    OutputDescriptor file(fresh, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW);
    if (old != nullptr && !file.copy_owner_and_mode(*old)) {
      unlink(fresh.c_str());
      return false;
    }
    file.write_all(text);
    file.sync();
    file.close();
    fs::rename(fresh, path);
  } catch (...) {
    unlink(fresh.c_str());
    throw;
  }
  const fs::path folder = path.parent_path();
  OutputDescriptor(folder.empty() ? "." : folder.string(), O_RDONLY | O_DIRECTORY).sync();
  return true;
}

}  // namespace

void write_output_file(const std::string& path, const std::string& text) {
  const fs::path target = behind_links(path);
  struct stat old {};
  const bool exists = stat(target.c_str(), &old) == 0;
  if (exists && !S_ISREG(old.st_mode)) {
    write_in_place(target, text, 0);
  } else if (!replace(target, exists ? &old : nullptr, text)) {
    write_in_place(target, text, O_TRUNC);
  }
}

}  // namespace robot_control
