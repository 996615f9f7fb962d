#pragma once
/// The logs of one folder and the room that they may take.
///
/// run.bag is the running log. Earlier logs are kept as run.1.bag, run.2.bag, …; a higher number is newer. All of them
/// together stay within the quota: before the running log grows beyond it, the oldest of the others are removed. The
/// running log itself is never removed or cut. There is no more room where it fills the quota, or where an older log
/// cannot be removed. Only regular files count and are removed.
///
/// The first `begin` locks the folder, because two writers would rename each other's logs. The lock (flock of the
/// folder itself) ends with the process. Some file systems have no locks; then there is none.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "files/descriptor.h"

namespace robot_control {

/// N of the file name PREFIX N SUFFIX ("run.7.csv"); nothing: it is another name.
std::optional<std::uint64_t> number_in(std::string_view name, std::string_view prefix,
                                       std::string_view suffix) noexcept;

class LogFolder {
 public:
  /// `quota`: bytes; 0: no limit.
  LogFolder(const std::string& directory, std::int64_t quota);

  /// Returns the path of the running log and makes the folder. An earlier run.bag is renamed to the next number, where
  /// it is a regular file that holds a message. Throws LogError where an earlier log cannot be kept, or where another
  /// process writes logs there.
  std::string begin();

  /// The path of the running log.
  std::string path() const;

  /// Removes older logs until the running log may have `bytes`; false: there is no such room.
  bool make_room(std::int64_t bytes);

  /// Returns the paths of the logs that were removed since the last call.
  std::vector<std::string> take_removed() { return std::exchange(removed_, {}); }

 private:
  struct Kept {
    std::uint64_t number;
    std::int64_t bytes;
  };
  void list_kept();
  void lock();
  std::string name(std::uint64_t number) const;

  std::string directory_;
  std::int64_t quota_;
  Descriptor lock_;         ///< of the folder
  std::vector<Kept> kept_;  ///< the oldest log stands last
  std::int64_t kept_bytes_ = 0;
  std::vector<std::string> removed_;
};

}  // namespace robot_control
