#pragma once
/// What a black box holds, as a run.bag.

#include <array>
#include <cstdint>
#include <functional>
#include <string>

#include "telemetry/log_error.h"

namespace robot_control {

/// Of the folder beside a bag in which it grows.
inline constexpr const char* kSavingSuffix = ".saving";

/// It holds no row.
class EmptyBlackBox : public LogError {
 public:
  using LogError::LogError;
};

/// The caller gave up.
class SavingGivenUp : public LogError {
 public:
  using LogError::LogError;
};

/// Called before each segment and record; true: the caller gives up.
using GiveUp = std::function<bool()>;

struct SavedBlackBox {
  std::uint64_t rows = 0;                   ///< of the bag: cycles
  std::array<std::int64_t, 4> newest_ns{};  ///< stamp of each node's newest row, by TraceRing; 0: it has none
  std::string missing = {};                 ///< what could not be read, as LogHeader::missing
};

/// Joins the rows of the file at `path` and writes them to `bag`, whole or not at all. The file may be in use; then the
/// newest rows may be missing. What is damaged or cut off is passed over: it is named in the header of the bag, and
/// the rows that are missing there count in the field `lost` of those that follow. Throws EmptyBlackBox, or LogError:
/// it is none, it is of another build, nothing of it is sound, or the bag cannot be written. Throws SavingGivenUp.
SavedBlackBox save_black_box(const std::string& path, std::uint64_t build, const std::string& bag,
                             const GiveUp& give_up = {});

}  // namespace robot_control
