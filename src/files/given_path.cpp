#include "files/given_path.h"

#include <pwd.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>
#include <system_error>

namespace robot_control {
namespace {

namespace fs = std::filesystem;

/// Holds the given text of every resolved path that differs from it.
struct GivenTexts {
  std::mutex mutex;
  std::map<std::string, std::string> by_path;
};

GivenTexts& given_texts() {
  static GivenTexts texts;
  return texts;
}

/// Returns "" if neither the environment nor the account has one.
std::string home() {
  if (const char* named = std::getenv("HOME"); named != nullptr && *named != 0) return named;
  const passwd* const account = getpwuid(getuid());
  return account == nullptr || account->pw_dir == nullptr ? "" : account->pw_dir;
}

std::string without_slash(std::string path) {
  while (path.size() > 1 && path.back() == '/') path.pop_back();
  return path;
}

}  // namespace

fs::path caller_folder() {
  if (const char* named = std::getenv(kCallerFolder); named != nullptr && *named != 0) return named;
  std::error_code ignored;
  return fs::current_path(ignored);
}

std::string resolved_path(const std::string& given, const fs::path& folder) {
  if (given.empty()) return given;
  const bool at_home = given.starts_with("~/") && !home().empty();
  const std::string path = (folder / (at_home ? home() + given.substr(1) : given)).lexically_normal().string();
  if (path != given) {
    const std::lock_guard lock(given_texts().mutex);
    given_texts().by_path[without_slash(path)] = without_slash(given);
  }
  return path;
}

std::string shown_path(const std::string& path) {
  const std::lock_guard lock(given_texts().mutex);
  for (std::string above = path; !above.empty(); above.resize(above.rfind('/'))) {
    const auto found = given_texts().by_path.find(above);
    if (found != given_texts().by_path.end()) return found->second + path.substr(above.size()) + " (" + path + ")";
    if (above.find('/') == std::string::npos) break;
  }
  return path;
}

std::string file_error(const std::string& path, const std::string& why) {
  const std::string shown = shown_path(path), end = " (" + path + ")";
  return shown == path ? path + ": " + why : shown.substr(0, shown.size() - end.size()) + ": " + why + end;
}

std::string failed(const std::string& operation, int error) {
  if (error == ENOENT) return "file not found";
  return "cannot be " + operation + ": " + (error == EACCES ? "no permission" : std::strerror(error));
}

}  // namespace robot_control
