#pragma once
/// All bytes of a file; "" if there is none.

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace robot_control {

inline std::string content(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace robot_control
