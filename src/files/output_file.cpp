#include "files/output_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <deque>
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

/// The new content of one file. Until `commit` the old one stays.
class Replacement {
 public:
  explicit Replacement(const OutputFile& file)
      : text_(file.text), target_(behind_links(file.path)), fresh_(target_.string() + ".new") {
    struct stat old {};
    const bool exists = stat(target_.c_str(), &old) == 0;
    regular_ = !exists || S_ISREG(old.st_mode);
    if (regular_) prepared_ = prepare(exists ? &old : nullptr);
  }
  Replacement(const Replacement&) = delete;
  Replacement& operator=(const Replacement&) = delete;
  ~Replacement() {
    if (prepared_) unlink(fresh_.c_str());
  }

  void commit() {
    if (!prepared_) return write_in_place(target_, text_, regular_ ? O_TRUNC : 0);
    fs::rename(fresh_, target_);
    prepared_ = false;
    const fs::path folder = target_.parent_path();
    OutputDescriptor(folder.empty() ? "." : folder.string(), O_RDONLY | O_DIRECTORY).sync();
  }

 private:
  /// Returns false if the owner of the old file cannot be kept.
  bool prepare(const struct stat* old) const {
    unlink(fresh_.c_str());  // left by a process that was killed
    try {
      OutputDescriptor file(fresh_, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW);
      if (old != nullptr && !file.copy_owner_and_mode(*old)) {
        unlink(fresh_.c_str());
        return false;
      }
      file.write_all(text_);
      file.sync();
      file.close();
      return true;
    } catch (...) {
      unlink(fresh_.c_str());
      throw;
    }
  }

  const std::string& text_;
  fs::path target_;
  std::string fresh_;
  bool regular_ = true, prepared_ = false;
};

}  // namespace

void write_output_files(const std::vector<OutputFile>& files) {
  std::deque<Replacement> replacements;
  for (const OutputFile& file : files) replacements.emplace_back(file);
  for (Replacement& replacement : replacements) replacement.commit();
}

void write_output_file(const std::string& path, const std::string& text) {
  write_output_files({{path, text}});
}

}  // namespace robot_control
