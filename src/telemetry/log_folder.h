#pragma once
/// The logs of one folder and the room that they may take.
///
/// run.csv is the running log; a run before it is kept as run.1.csv, run.2.csv …, the higher the number the newer. All
/// of them together stay within the quota: before the running log grows beyond it, the oldest of the others are
/// removed. The running log itself is never removed or cut. Where it fills the quota alone, or an older one cannot be
/// removed, there is no more room and the log ends. Only regular files count and are removed.

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace robot_control {

class LogFolder {
 public:
  /// `quota`: bytes; 0: no limit.
  LogFolder(const std::string& directory, std::int64_t quota);

  /// Keeps an earlier run.csv under the next number, where that is a regular file; what else stands there is written
  /// to. The path of the running log. Throws LogError where it cannot be kept.
  std::string begin();

  /// Room for a running log of `bytes`? Removes older ones.
  bool make_room(std::int64_t bytes);

  /// Paths of the logs that were removed since the last call.
  std::vector<std::string> take_removed() { return std::exchange(removed_, {}); }

 private:
  struct Kept {
    std::uint64_t number;
    std::int64_t bytes;
  };
  void look();
  std::string name(std::uint64_t number) const;

  std::string directory_;
  std::int64_t quota_;
  std::vector<Kept> kept_;  ///< oldest last
  std::int64_t kept_bytes_ = 0;
  std::vector<std::string> removed_;
};

}  // namespace robot_control
