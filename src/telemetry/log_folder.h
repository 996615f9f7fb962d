#pragma once
/// The logs of one folder and the room that they may take.
///
/// run.csv and run.bag are the running logs; what was there before is kept as run.1.csv, run.2.bag, …, the higher the
/// number the newer. All of them together stay within the quota: before a running log grows beyond it, the oldest of
/// the others are removed. A running log itself is never removed or cut. Where the running ones fill the quota, or an
/// older one cannot be removed, there is no more room. Beside a run.bag, run.csv takes half of the quota at most. Only
/// regular files count and are removed.
///
/// From the first `begin` on, the folder is locked: two that write there would rename each other's logs. The lock
/// (flock of the folder itself) ends with the process. Where the file system has no locks, there is none.

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace robot_control {

enum class LogKind { kCsv, kBag };

class LogFolder {
 public:
  /// `quota`: bytes; 0: no limit.
  LogFolder(const std::string& directory, std::int64_t quota);
  ~LogFolder();
  LogFolder(const LogFolder&) = delete;
  LogFolder& operator=(const LogFolder&) = delete;

  /// Keeps an earlier run.csv or run.bag under the next number, where that is a regular file that holds something; what
  /// else stands there is written to. Makes the folder. The path of the running log. Throws LogError where an earlier
  /// one cannot be kept, or another process writes logs there.
  std::string begin(LogKind kind);

  /// Of the running log.
  std::string path(LogKind kind) const;

  /// Room for a running log of `bytes`? Removes older ones.
  bool make_room(LogKind kind, std::int64_t bytes);

  /// Paths of the logs that were removed since the last call.
  std::vector<std::string> take_removed() { return std::exchange(removed_, {}); }

 private:
  struct Kept {
    std::uint64_t number;
    LogKind kind;
    std::int64_t bytes;
  };
  void look();
  void lock();
  std::string name(std::uint64_t number, LogKind kind) const;

  std::string directory_;
  std::int64_t quota_;
  int lock_ = -1;                          ///< descriptor of the folder
  std::array<std::int64_t, 2> running_{};  ///< bytes, by LogKind
  std::vector<Kept> kept_;                 ///< oldest last
  std::int64_t kept_bytes_ = 0;
  std::vector<std::string> removed_;
};

}  // namespace robot_control
