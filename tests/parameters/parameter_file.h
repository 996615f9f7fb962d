#pragma once
/// A YAML file for a test: the shipped one with replaced lines.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "configuration/parameters.h"
#include "parameters/schema.h"
#include "support/message_of.h"

namespace robot_control {

inline std::string shipped_path() {
  return PROJECT_DIRECTORY "/config/robot_params.yaml";
}

inline std::string shipped_text() {
  std::ostringstream text;
  text << std::ifstream(shipped_path()).rdbuf();
  return text.str();
}

/// All blocks, with places of their own.
inline std::vector<Block> blocks() {
  static Parameters parameters;
  return schema(parameters).blocks;
}

/// Every path that may be set ("robot.rate", …), in the order of the schema.
inline std::vector<std::string> parameter_paths() {
  std::vector<std::string> paths;
  for (const Block& block : blocks()) {
    for (const Key& key : block.keys) paths.push_back(path_of(block, key));
  }
  return paths;
}

/// Number of problems, of which each has a line.
inline std::size_t problems_in(const std::string& message) {
  return static_cast<std::size_t>(std::count(message.begin(), message.end(), '\n'));
}

class ParameterFile {
 public:
  ParameterFile() {
    std::string name = (std::filesystem::temp_directory_path() / "robot_control_XXXXXX").string();
    folder_ = mkdtemp(name.data());
    write(shipped_text());
  }
  ~ParameterFile() { std::filesystem::remove_all(folder_); }
  ParameterFile(const ParameterFile&) = delete;
  ParameterFile& operator=(const ParameterFile&) = delete;

  std::string path() const { return (folder_ / "params.yaml").string(); }
  std::filesystem::path folder() const { return folder_; }

  void write(const std::string& text) {
    text_ = text;
    std::ofstream(path(), std::ios::trunc | std::ios::binary) << text;
  }

  void append(const std::string& text) { write(text_ + text); }

  /// Replaces the line of `key` (the `nth` of that name) by `line`; an empty `line` removes it.
  void set(const std::string& key, const std::string& line, int nth = 1) {
    std::istringstream from(text_);
    std::string result;
    for (std::string old; std::getline(from, old);) {
      if (old.starts_with("  " + key + ":") && --nth == 0) {
        if (!line.empty()) result += line + "\n";
      } else {
        result += old + "\n";
      }
    }
    EXPECT_LE(nth, 0) << key << " does not stand in the file";
    write(result);
  }

  /// The value of `key` in the map `group`, on one line or with a line per key; an empty `value` removes the key.
  void set_in(const std::string& group, const std::string& key, const std::string& value) {
    const std::size_t line = text_.find("\n  " + group + ":") + 1;
    const bool on_one_line = text_.substr(line, text_.find('\n', line) - line).find('{') != std::string::npos;
    const std::size_t begin = text_.find((on_one_line ? "" : "    ") + key + ": ", line);
    const std::size_t end = text_.find_first_of(on_one_line ? ",}" : "\n", begin);
    ASSERT_NE(end, std::string::npos) << group << "." << key << " does not stand in the file";
    std::string text = text_;
    if (!on_one_line) {
      write(text.replace(begin, end + 1 - begin, value.empty() ? "" : "    " + key + ": " + value + "\n"));
    } else if (!value.empty()) {
      write(text.replace(begin, end - begin, key + ": " + value));
    } else if (text[end] == ',') {
      write(text.erase(begin, end + 2 - begin));
    } else {
      write(text.erase(begin, end - begin));
    }
  }

  /// 1-based number of the `nth` line that begins with `start`.
  int line_of(const std::string& start, int nth = 1) const {
    std::istringstream from(text_);
    int number = 0;
    for (std::string line; std::getline(from, line);) {
      ++number;
      if (line.starts_with(start) && --nth == 0) return number;
    }
    return 0;
  }

  /// The message of read_parameters; empty if it accepts the file.
  std::string refusal(const std::vector<Overlay>& overlays = {}) const {
    return message_of<ParameterError>([&] { read_parameters(path(), overlays); });
  }

 private:
  std::filesystem::path folder_;
  std::string text_;
};

}  // namespace robot_control
