#pragma once
/// The folder with descriptions of real robots, and their true data in TRUTH.json. ROBOT_CORPUS names it; otherwise it
/// is `shared/robots` above the repository. Tests that need it skip if it is absent.

#include <cstdlib>
#include <filesystem>

namespace robot_control {

inline constexpr const char* kNoCorpus = "no folder of real robots: set ROBOT_CORPUS";

/// Empty if there is none.
inline std::filesystem::path corpus() {
  if (const char* named = std::getenv("ROBOT_CORPUS")) return named;
  for (std::filesystem::path folder = PROJECT_DIRECTORY; folder != folder.root_path(); folder = folder.parent_path()) {
    if (std::filesystem::exists(folder / "shared/robots/TRUTH.json")) return folder / "shared/robots";
  }
  return {};
}

}  // namespace robot_control
