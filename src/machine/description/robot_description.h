#pragma once
/// Defines the text of a robot description and the form of messages about its errors.

#include <stdexcept>
#include <string>

namespace robot_control {

/// Its message states the error, its file and element, and the remedy. In a longer message "…" replaces the middle.
class RobotError : public std::runtime_error {
 public:
  explicit RobotError(const std::string& message);
};

inline constexpr std::size_t kMaxRefusal = 1900;  ///< bytes

/// Returns true if `bytes` is the pointer that git-LFS leaves in place of a file until it is fetched.
bool is_lfs_pointer(const std::string& bytes);
inline constexpr const char* kLfsPointer = "it is a git-LFS pointer, not the file itself";
inline constexpr const char* kLfsRemedy = "Fetch the file: git lfs pull";

/// Throws RobotError with the message "<source>: <element>: <what>. <remedy>."
[[noreturn]] void refuse(const std::string& source, const std::string& element, const std::string& what,
                         const std::string& remedy);

/// Throws RobotError with three lines: "<source>: <element>: <problem>.", "Found: <found>.", "Fix: <fix>."
[[noreturn]] void refuse(const std::string& source, const std::string& element, const std::string& problem,
                         const std::string& found, const std::string& fix);

/// Holds a URDF text and where it was read, for messages ("urdf/diffbot.urdf", "/robot_description").
struct RobotDescription {
  std::string text;
  std::string source;
};

/// Reads a file. Throws RobotError with its name if it is unreadable or a git-LFS pointer. A file whose name ends in
/// .xacro is expanded first (xacro.h).
RobotDescription load_description(const std::string& path);

}  // namespace robot_control
