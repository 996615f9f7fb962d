#pragma once
/// The folders with descriptions of real robots: those on wheels with their true data in TRUTH.json, and quadrupeds
/// with FACTS.json. ROBOT_CORPUS and ROBOT_QUADRUPEDS name them; otherwise they are `shared/robots` and
/// `shared/quadrupeds` above the repository. Tests that need one skip if it is absent.

#include <cstdlib>
#include <filesystem>

namespace robot_control {

inline constexpr const char* kNoCorpus = "no folder of real robots: set ROBOT_CORPUS";
inline constexpr const char* kNoQuadrupeds = "no folder of quadrupeds: set ROBOT_QUADRUPEDS";

/// Returns the folder that `variable` names, else the one with `file` above the repository; empty if there is none.
inline std::filesystem::path described_robots(const char* variable, const std::filesystem::path& file) {
  if (const char* named = std::getenv(variable)) return named;
  for (std::filesystem::path folder = PROJECT_DIRECTORY; folder != folder.root_path(); folder = folder.parent_path()) {
    if (std::filesystem::exists(folder / file)) return (folder / file).parent_path();
  }
  return {};
}

inline std::filesystem::path corpus() {
  return described_robots("ROBOT_CORPUS", "shared/robots/TRUTH.json");
}

inline std::filesystem::path quadrupeds() {
  return described_robots("ROBOT_QUADRUPEDS", "shared/quadrupeds/FACTS.json");
}

}  // namespace robot_control
