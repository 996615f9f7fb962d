#include "parameters/text_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace robot_control {

std::optional<std::string> read_text_file(const std::string& path, const std::string& remedy, ProblemList& problems) {
  const auto refuse = [&](const std::string& why) {
    problems.add({path, "", "cannot be read: " + why, "", remedy});
    return std::nullopt;
  };
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) return refuse("is a folder");
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) return refuse(std::strerror(errno));
  std::ostringstream text;
  const bool empty = file.peek() == std::ifstream::traits_type::eof();
  if (!empty && !(text << file.rdbuf())) return refuse(std::strerror(errno));
  return text.str();
}

}  // namespace robot_control
