#pragma once
/// Paths as a user gives them.
///
/// `~/` stands for the user's home: HOME, else that of the account. A relative path in a file counts from the folder of
/// that file, any other one from caller_folder(). Each program resolves a path before it opens the file.

#include <filesystem>
#include <string>

namespace robot_control {

/// Environment variable in which a launch file passes the folder of its caller on, because roslaunch starts nodes in
/// another one.
inline constexpr const char* kCallerFolder = "ROBOT_CONTROL_CALLER_FOLDER";

/// Returns the folder that kCallerFolder names, else the current one.
std::filesystem::path caller_folder();

/// Returns the absolute path; "" for "". A '/' at its end stays. The given text is kept for shown_path.
std::string resolved_path(const std::string& given, const std::filesystem::path& folder = caller_folder());

/// Returns the path with the text from which it or a folder above it was resolved: "rel/x.urdf (/here/rel/x.urdf)".
std::string shown_path(const std::string& path);

/// Returns "rel/x.urdf: <why> (/here/rel/x.urdf)".
std::string file_error(const std::string& path, const std::string& why);

/// Returns the failed operation ("read") and its errno in words: "file not found", "cannot be read: no permission".
std::string failed(const std::string& operation, int error);

}  // namespace robot_control
