#pragma once
/// This function saves the contents of a black box as a run.bag.

#include <array>
#include <cstdint>
#include <functional>
#include <string>

#include "log/log_error.h"

namespace robot_control {

/// A bag grows in a folder beside it that has this suffix.
inline constexpr const char* kSavingSuffix = ".saving";

/// The black box holds no row.
class EmptyBlackBox : public LogError {
 public:
  using LogError::LogError;
};

/// The caller gave saving up.
class SavingGivenUp : public LogError {
 public:
  using LogError::LogError;
};

/// It is called before each chunk and row; true: the caller gives up.
using GiveUp = std::function<bool()>;

struct SavedBlackBox {
  std::uint64_t rows = 0;                   ///< number of rows in the bag
  std::array<std::int64_t, 4> newest_ns{};  ///< stamp of each node's newest row, by TraceRing; 0: it has none
  std::string missing = {};                 ///< unreadable parts, as in LogHeader::missing
};

/// Writes the rows of the ring at `path` (black_box.h) to `bag`, whole or not at all. The ring may be in use; then the
/// newest rows may be missing. Damaged parts are passed over. The header of the bag names them, and the field `lost` of
/// the rows behind counts the missing rows. Throws EmptyBlackBox or SavingGivenUp. Throws LogError if the folder is no
/// black box of this version, has no sound row, or the bag cannot be written.
SavedBlackBox save_black_box(const std::string& path, const std::string& bag, const GiveUp& give_up = {});

}  // namespace robot_control
