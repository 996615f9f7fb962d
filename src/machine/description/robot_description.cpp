#include "machine/description/robot_description.h"

#include <utility>

#include "files/given_path.h"
#include "files/input_file.h"
#include "files/message_text.h"
#include "machine/description/xacro.h"

namespace robot_control {
namespace {

bool ends_with_xacro(const std::string& path) {
  const std::string ending = ".xacro";
  return path.size() >= ending.size() && path.compare(path.size() - ending.size(), ending.size(), ending) == 0;
}

bool continues_character(char byte) {
  return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U;
}

std::string shortened(const std::string& message) {
  if (message.size() <= kMaxRefusal) return message;
  std::size_t first = kMaxRefusal * 2 / 3;
  std::size_t rest = message.size() - kMaxRefusal / 3;
  while (first > 0 && continues_character(message[first])) --first;
  while (rest < message.size() && continues_character(message[rest])) ++rest;
  return message.substr(0, first) + " … " + message.substr(rest);
}

}  // namespace

RobotError::RobotError(const std::string& message) : std::runtime_error(shortened(message)) {}

bool is_lfs_pointer(const std::string& bytes) {
  return bytes.starts_with("version https://git-lfs.github.com/spec/");
}

void refuse(const std::string& source, const std::string& element, const std::string& what, const std::string& remedy) {
  // TinyXML's sentences already have a full stop.
  const std::string sentence = what.substr(0, what.find_last_not_of('.') + 1);
  const std::string fix = sentence.find('\n') == std::string::npos ? ". " : ".\nFix: ";
  throw RobotError(printable(source) + ": " + printable(element) + ": " + fit_for_message(sentence) + fix +
                   fit_for_message(remedy) + ".");
}

void refuse(const std::string& source, const std::string& element, const std::string& problem, const std::string& found,
            const std::string& fix) {
  refuse(source, element, problem + ".\nFound: " + found, fix);
}

RobotDescription load_description(const std::string& path) {
  InputFile file = read_input_file(path, kMaxDescription);
  if (file.problem.empty() && is_lfs_pointer(file.text)) refuse(path, "URDF", kLfsPointer, kLfsRemedy);
  if (ends_with_xacro(path)) return {expand_xacro(path), path};
  if (!file.problem.empty())
    throw RobotError(fit_for_message(file_error(path, file.problem)) + ". Give the path of an existing URDF file.");
  if (file.text.empty()) refuse(path, "URDF", "the file is empty", "Give the path of a URDF file");
  return {std::move(file.text), path};
}

}  // namespace robot_control
