#pragma once
/// check_scene_files checks the files of a scene before MuJoCo opens them: the MJCF itself and every file that an
/// attribute `file` names. It also searches included files, and the folders of `meshdir`, `texturedir` and `assetdir`
/// beside the scene's folder.

#include <string>

namespace robot_control {

/// Throws DriverError if the scene or an existing file that it names is no regular file of at most kMaxDescription
/// bytes. MuJoCo itself reports missing files.
void check_scene_files(const std::string& scene);

}  // namespace robot_control
