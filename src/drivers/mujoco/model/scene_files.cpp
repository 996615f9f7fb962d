#include "drivers/mujoco/model/scene_files.h"

#include <filesystem>
#include <set>
#include <string_view>
#include <vector>

#include "drivers/driver.h"
#include "files/given_path.h"
#include "files/input_file.h"
#include "files/message_text.h"

namespace robot_control {
namespace {

constexpr std::string_view kXmlBlank = " \t\r\n";

/// Returns the values of all attributes `name="…"` in the text.
std::vector<std::string> attribute_values(std::string_view text, std::string_view name) {
  std::vector<std::string> values;
  for (std::size_t at = text.find(name); at != std::string_view::npos; at = text.find(name, at + 1)) {
    if (at == 0 || kXmlBlank.find(text[at - 1]) == std::string_view::npos) continue;
    std::size_t next = text.find_first_not_of(kXmlBlank, at + name.size());
    if (next == std::string_view::npos || text[next] != '=') continue;
    next = text.find_first_not_of(kXmlBlank, next + 1);
    if (next == std::string_view::npos || (text[next] != '"' && text[next] != '\'')) continue;
    const std::size_t end = text.find(text[next], next + 1);
    if (end == std::string_view::npos) continue;
    values.emplace_back(text.substr(next + 1, end - next - 1));
  }
  return values;
}

class SceneFiles {
 public:
  explicit SceneFiles(const std::filesystem::path& scene) : folder_(scene.parent_path()), folders_{""} { read(scene); }

 private:
  [[noreturn]] static void refuse_scene(const std::filesystem::path& path, const std::string& problem) {
    throw DriverError(fit_for_message(file_error(path.string(), problem)) +
                      ". Set mujoco_plant/scene to an MJCF file whose files are regular ones.");
  }

  void read(const std::filesystem::path& path) {
    if (!seen_.insert(path).second) return;
    const InputFile file = read_input_file(path, kMaxDescription);
    if (!file.problem.empty()) refuse_scene(path, file.problem);
    for (const std::string_view name : {"meshdir", "texturedir", "assetdir"}) {
      for (const std::string& folder : attribute_values(file.text, name)) folders_.insert(folder);
    }
    for (const std::string& name : attribute_values(file.text, "file")) {
      for (const std::filesystem::path& folder : folders_) look_at(folder_ / folder / name);
    }
  }

  void look_at(const std::filesystem::path& path) {
    std::error_code error;
    if (!std::filesystem::exists(path, error)) return;
    const std::string problem = input_file_problem(path, kMaxDescription);
    if (!problem.empty()) refuse_scene(path, problem);
    if (path.extension() == ".xml" || path.extension() == ".mjcf") read(path);
  }

  std::filesystem::path folder_;
  std::set<std::filesystem::path> folders_;  ///< folders for assets, relative to the scene's folder
  std::set<std::filesystem::path> seen_;
};

}  // namespace

void check_scene_files(const std::string& scene) {
  SceneFiles{scene};
}

}  // namespace robot_control
