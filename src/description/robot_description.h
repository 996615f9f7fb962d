#pragma once
/// The text of a robot description, and the form of the messages about what is wrong with it.

#include <stdexcept>
#include <string>

namespace robot_control {

/// One message: what is wrong, in which file and element, and what to do about it. Longer ones lose their middle:
/// "…" stands for it.
class RobotError : public std::runtime_error {
 public:
  explicit RobotError(const std::string& message);
};

inline constexpr std::size_t kLongestRefusal = 1900;  ///< bytes

/// Whether a file holds what git-LFS leaves in its place until it is fetched.
bool is_lfs_pointer(const std::string& bytes);
inline constexpr const char* kLfsPointer = "it is a git-LFS pointer, not the file itself";
inline constexpr const char* kLfsRemedy = "Fetch the file: git lfs pull";

/// "<source>: <element>: <what>. <remedy>."
[[noreturn]] void refuse(const std::string& source, const std::string& element, const std::string& what,
                         const std::string& remedy);

/// A URDF text and where it was read, for messages ("urdf/diffbot.urdf", "/robot_description").
struct RobotDescription {
  std::string text;
  std::string source;
};

/// Reads a file; throws RobotError naming it: unreadable, a git-LFS pointer. A name that ends in .xacro is expanded
/// first (xacro.h).
RobotDescription load_description(const std::string& path);

}  // namespace robot_control
