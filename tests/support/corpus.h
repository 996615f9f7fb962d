#pragma once
/// Where descriptions of real robots lie (TRUTH.json says what is true of them): the folder named by ROBOT_CORPUS, else
/// `shared/robots` above the repository. Tests that need them skip where they are absent.

#include <cstdlib>
#include <filesystem>

namespace robot_control {

inline constexpr const char* kNoCorpus = "no folder of real robots: set ROBOT_CORPUS";

/// Empty where there is none.
inline std::filesystem::path corpus() {
  if (const char* named = std::getenv("ROBOT_CORPUS")) return named;
  for (std::filesystem::path folder = PROJECT_DIRECTORY; folder != folder.root_path(); folder = folder.parent_path()) {
    if (std::filesystem::exists(folder / "shared/robots/TRUTH.json")) return folder / "shared/robots";
  }
  return {};
}

}  // namespace robot_control
