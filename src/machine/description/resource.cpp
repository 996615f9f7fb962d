#include "machine/description/resource.h"

#include <tinyxml.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <optional>
#include <sstream>
#include <string_view>
#include <vector>

#include "files/input_file.h"
#include "machine/description/environment.h"

namespace robot_control {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPackage = "package://";
constexpr std::string_view kFile = "file://";

constexpr std::size_t kMaxManifest = std::size_t{1} << 20U;  // bytes

std::vector<fs::path> folders_of(const std::string& search_path) {
  std::vector<fs::path> folders;
  std::istringstream stream(search_path);
  for (std::string folder; std::getline(stream, folder, ':');) {
    if (!folder.empty()) folders.emplace_back(folder);
  }
  return folders;
}

bool is_there(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error);
}

bool is_folder(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error);
}

std::string package_name(const fs::path& folder) {
  TiXmlDocument xml;
  xml.Parse(read_input_file(folder / "package.xml", kMaxManifest).text.c_str());
  if (!xml.Error() && xml.FirstChildElement("package") != nullptr) {
    const TiXmlElement* name = xml.FirstChildElement("package")->FirstChildElement("name");
    if (name != nullptr && name->GetText() != nullptr) {
      std::istringstream text(name->GetText());
      std::string word;
      text >> word;
      if (!word.empty()) return word;
    }
  }
  return folder.filename().empty() ? folder.parent_path().filename() : folder.filename();
}

using Packages = std::map<std::string, fs::path>;

void crawl(const fs::path& folder, int depth, Packages& packages) {
  if (is_there(folder / "CATKIN_IGNORE")) return;
  if (is_there(folder / "package.xml") || is_there(folder / "manifest.xml")) {
    packages.emplace(package_name(folder), folder);  // The first package of a name counts.
    return;
  }
  if (depth == 0 || is_there(folder / "rospack_nosubdirs")) return;
  std::error_code error;
  std::vector<fs::path> inside;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (is_folder(entry->path()) && !entry->path().filename().string().starts_with('.'))
      inside.push_back(entry->path());
  }
  std::sort(inside.begin(), inside.end());
  for (const fs::path& next : inside) crawl(next, depth - 1, packages);
}

/// Returns the packages below one entry of the search path.
const Packages& crawled(const fs::path& entry) {
  static std::mutex mutex;
  static std::map<fs::path, Packages> remembered;
  const std::lock_guard lock(mutex);
  const auto [found, is_new] = remembered.try_emplace(entry);
  if (is_new) crawl(entry, kPackageDepth, found->second);
  return found->second;
}

std::optional<fs::path> on_search_path(const std::string& package) {
  for (const fs::path& entry : folders_of(environment("ROS_PACKAGE_PATH"))) {
    // This avoids the crawl in the usual case.
    if (is_there(entry / package / "package.xml") && package_name(entry / package) == package) return entry / package;
    const Packages& packages = crawled(entry);
    if (const auto found = packages.find(package); found != packages.end()) return found->second;
  }
  return {};
}

std::optional<fs::path> folder_of_urdf(const RobotDescription& description) {
  std::error_code error;
  if (!fs::is_regular_file(description.source, error)) return {};
  const fs::path file = fs::absolute(description.source, error);
  return error ? std::nullopt : std::optional(file.parent_path());
}

std::optional<fs::path> above_urdf(const std::string& package, const std::string& file,
                                   const RobotDescription& description) {
  const std::optional<fs::path> start = folder_of_urdf(description);
  if (!start) return {};
  for (fs::path folder = start->lexically_normal(); folder != folder.root_path(); folder = folder.parent_path()) {
    if (is_there(folder / "package.xml") && package_name(folder) == package) return folder;
    // A folder may have the name by chance.
    if (is_there(folder / package / "package.xml") || is_there(folder / package / file)) return folder / package;
  }
  return {};
}

std::optional<fs::path> find_package(const std::string& package, const std::string& file,
                                     const RobotDescription& description) {
  if (std::optional<fs::path> folder = on_search_path(package)) return folder;
  for (const fs::path& prefix : folders_of(environment("CMAKE_PREFIX_PATH"))) {
    if (is_folder(prefix / "share" / package)) return prefix / "share" / package;
  }
  return above_urdf(package, file, description);
}

std::string element_of(const std::string& uri) {
  return "<mesh filename=\"" + uri + "\">";
}

fs::path package_file(const std::string& uri, const RobotDescription& description) {
  const std::string rest = uri.substr(kPackage.size());
  const std::size_t slash = rest.find('/');
  const std::string package = rest.substr(0, slash);
  if (package.empty() || slash == std::string::npos) {
    refuse(description.source, element_of(uri), "its filename names no file in a package",
           "Set it to package://PACKAGE/PATH");
  }
  const std::string file = rest.substr(slash + 1);
  const std::optional<fs::path> folder = find_package(package, file, description);
  if (!folder) {
    const std::string searched = environment("ROS_PACKAGE_PATH");
    refuse(description.source, element_of(uri),
           "package not found: \"" + package + "\", not in ROS_PACKAGE_PATH (" +
               (searched.empty() ? "which is not set" : searched) + "), not in share/ of CMAKE_PREFIX_PATH" +
               (folder_of_urdf(description) ? ", not in the folder of the URDF or above it" : ""),
           "Install it, or add the folder that holds it to ROS_PACKAGE_PATH");
  }
  return *folder / file;
}

int hexadecimal(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::string decoded(const std::string& text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool is_code =
        text[i] == '%' && i + 2 < text.size() && hexadecimal(text[i + 1]) >= 0 && hexadecimal(text[i + 2]) >= 0;
    result += is_code ? static_cast<char>(16 * hexadecimal(text[i + 1]) + hexadecimal(text[i + 2])) : text[i];
    if (is_code) i += 2;
  }
  return result;
}

fs::path locate(const std::string& uri, const RobotDescription& description) {
  if (uri.starts_with(kPackage)) return package_file(uri, description);
  if (uri.starts_with(kFile)) {
    const std::string path = decoded(uri.substr(kFile.size()));
    constexpr std::string_view kHost = "localhost/";
    return path.starts_with(kHost) ? path.substr(kHost.size() - 1) : path;
  }
  if (const std::size_t scheme = uri.find("://"); scheme != std::string::npos) {
    refuse(description.source, element_of(uri), "\"" + uri.substr(0, scheme) + "://\" is not supported",
           "Replace it with package://, file:// or a path");
  }
  fs::path path = uri;
  if (path.is_absolute()) return path;
  const std::optional<fs::path> folder = folder_of_urdf(description);
  if (!folder) {
    refuse(description.source, element_of(uri), "a relative path needs the folder of a URDF file",
           "Replace it with package:// or an absolute path, or give the URDF as a file");
  }
  return *folder / path;
}

}  // namespace

fs::path resolve_resource(const std::string& uri, const RobotDescription& description) {
  if (uri.find_first_not_of(" \t\r\n") == std::string::npos) {
    refuse(description.source, element_of(uri), "it names no file", "Set its filename");
  }
  fs::path path = locate(uri, description);
  if (is_there(path)) return path;
  // In a/b/../c, where b does not exist, the path is normalised as in a URL.
  if (fs::path cleaned = path.lexically_normal(); is_there(cleaned)) return cleaned;
  refuse(description.source, element_of(uri), "file not found: " + path.string(),
         "Add the file, or correct its name (upper and lower case differ)");
}

}  // namespace robot_control
