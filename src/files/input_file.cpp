#include "files/input_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "files/descriptor.h"
#include "files/given_path.h"

namespace robot_control {
namespace {

std::string problem_of(const struct stat& status, std::size_t max_bytes) {
  const std::string only = "; only a regular file is read";
  switch (status.st_mode & S_IFMT) {
    case S_IFREG:
      break;
    case S_IFDIR:
      return "is a folder" + only;
    case S_IFIFO:
      return "is a FIFO" + only;
    case S_IFSOCK:
      return "is a socket" + only;
    default:
      return "is a device" + only;
  }
  if (static_cast<std::size_t>(status.st_size) <= max_bytes) return "";
  return "has " + std::to_string(status.st_size) + " bytes, at most " + std::to_string(max_bytes) + " are read";
}

}  // namespace

std::string input_file_problem(const std::string& path, std::size_t max_bytes) {
  struct stat status {};
  if (path.find('\0') != std::string::npos) return "the file name contains a NUL character";
  return stat(path.c_str(), &status) == 0 ? problem_of(status, max_bytes) : failed("read", errno);
}

InputFile read_input_file(const std::string& path, std::size_t max_bytes) {
  InputFile result;
  const auto refused = [&](const std::string& problem) { return InputFile{.text = "", .problem = problem}; };
  if (const std::string problem = input_file_problem(path, max_bytes); !problem.empty()) return refused(problem);
  const Descriptor file(open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC));
  struct stat status {};
  if (!file.open() || fstat(file.number(), &status) != 0) return refused(failed("read", errno));
  if (const std::string problem = problem_of(status, max_bytes); !problem.empty()) return refused(problem);
  constexpr std::size_t kPiece = std::size_t{1} << 16U;
  result.text.reserve(static_cast<std::size_t>(status.st_size));
  for (;;) {  // reads up to the end: files of /proc have size 0, others may grow
    const std::size_t before = result.text.size();
    result.text.resize(before + std::min(kPiece, max_bytes + 1 - before));
    const ssize_t count = read(file.number(), result.text.data() + before, result.text.size() - before);
    const int error = errno;
    result.text.resize(before + static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
    if (count < 0 && error == EINTR) continue;
    if (count < 0) return refused(failed("read", error));
    if (count == 0) return result;
    if (result.text.size() > max_bytes) return refused("has more than " + std::to_string(max_bytes) + " bytes");
  }
}

}  // namespace robot_control
