#pragma once
/// Every column of the log, once: name, unit, where it comes from and how to get it out of a row.
///
/// Names are those of the frames' members. Bits and enums are integers; their meaning stands where `unit`
/// points: the enum of that name in signals/. Poses are planar (x, y, yaw): truth in the world minus the pose at
/// cycle 0, the estimate in odom; twists in base axes; yaw in (−π, π]. estimate_roll and estimate_pitch are those of
/// the attitude against gravity, wheel_odom_… the wheels alone by the model's numbers. NaN: there is none (no speed
/// limit, no battery). `tuning` counts the sets of live parameters; behind it stands what held in this cycle, derived
/// values among them (signals/drive_tuning.h): a joint that no loop drives has gains 0. `evidence_…`: by what the first
/// cause became active, else the first warning; unit by its row in signals/cause_names.h.

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "telemetry/joined_row.h"

namespace robot_control {

enum class ColumnSource : std::size_t { kRow, kDriver, kEstimator, kController, kMonitor };

/// Which of the sources a row has, by ColumnSource: the same for all columns, of which there are more than a hundred.
using PresentSources = std::array<bool, 5>;
PresentSources present_sources(const JoinedRow& row) noexcept;

enum class ColumnKind {
  kPhysical,  ///< the same in every run of the same seed, script and parameters, whatever the clock
  kTiming,    ///< when it happened: wall-clock runs only
};

struct Column {
  std::string name;
  std::string unit;  ///< "m", "rad/s", "" for counts, or the name of the enum
  ColumnSource source = ColumnSource::kRow;
  ColumnKind kind = ColumnKind::kPhysical;
  std::size_t joint = 0;  ///< index handed to the getters; columns of one joint, sensor or axis only
  /// Exactly one of the two is set. Call only where `source` is present.
  double (*real)(const JoinedRow& row, std::size_t joint) = nullptr;
  std::int64_t (*integer)(const JoinedRow& row, std::size_t joint) = nullptr;

  /// False: the row's cell is empty. `present`: those of the row.
  bool filled(const PresentSources& present) const noexcept { return present[static_cast<std::size_t>(source)]; }

  /// As a double, for arrays: NaN where the cell is empty. Integers are exact up to 2^53.
  double value(const JoinedRow& row, const PresentSources& present) const noexcept {
    if (!filled(present)) return std::numeric_limits<double>::quiet_NaN();
    return real != nullptr ? real(row, joint) : static_cast<double>(integer(row, joint));
  }
};

/// `joints`: names in the order of RobotModel::joints. `timing`: with the columns of kind kTiming.
std::vector<Column> log_columns(const std::vector<std::string>& joints, bool timing);

}  // namespace robot_control
