#include "log/bag/bag_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "files/input_file.h"
#include "log/bag/bag_error.h"

namespace robot_control {

BagFile::BagFile(const std::string& path) {
  if (const std::string problem = input_file_problem(path, kMaxBag); !problem.empty()) {
    throw std::runtime_error(problem);
  }
  file_ = Descriptor(open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC));
  if (!file_.open()) throw std::runtime_error(std::strerror(errno));
  struct stat status {};
  if (fstat(file_.number(), &status) != 0 || !S_ISREG(status.st_mode))
    throw std::runtime_error("is no regular file any more");
  size_ = static_cast<std::uint64_t>(status.st_size);
}

std::string_view BagFile::read(std::uint64_t offset, std::size_t count, const std::string& field) {
  const std::uint64_t available = offset < size_ ? size_ - offset : 0;
  if (count > available) {
    throw BagError({.offset = offset}, field,
                   std::to_string(count) + " bytes, but the file ends after " + std::to_string(available), true);
  }
  if (offset < begin_ || offset + count > begin_ + window_.size()) {
    constexpr std::size_t kAhead = std::size_t{4} << 20U;  // a whole bag of a black box, which may be overwritten
    const std::size_t got =
        fill(offset, static_cast<std::size_t>(std::min<std::uint64_t>(std::max(count, kAhead), available)));
    if (got < count) throw BagError({.offset = offset + got}, field, "the file became shorter while it was read", true);
  }
  return std::string_view(window_).substr(offset - begin_, count);
}

std::size_t BagFile::fill(std::uint64_t offset, std::size_t count) {
  begin_ = offset;
  window_.resize(count);
  std::size_t got = 0;
  while (got < count) {
    const ssize_t more = pread(file_.number(), window_.data() + got, count - got, static_cast<off_t>(offset + got));
    if (more < 0 && errno == EINTR) continue;
    if (more < 0) throw BagError({.offset = offset + got}, "data", std::strerror(errno));
    if (more == 0) break;
    got += static_cast<std::size_t>(more);
  }
  window_.resize(got);
  return got;
}

}  // namespace robot_control
