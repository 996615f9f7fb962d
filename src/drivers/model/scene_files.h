#pragma once
/// The files of a scene before MuJoCo opens them: the MJCF itself and, in it and in what it includes, everything that
/// an attribute `file` names, in the scene's folder and in those of `meshdir`, `texturedir` and `assetdir`.

#include <string>

namespace robot_control {

/// Throws DriverError: the scene is no regular file of at most kMaxDescription bytes, or a file that it names is
/// there and is none. What is not there is left to MuJoCo's own message.
void check_scene_files(const std::string& scene);

}  // namespace robot_control
