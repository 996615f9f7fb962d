#pragma once
/// Whether a laser can be trusted, from its messages alone.
///
/// A message is refused that has less than two rays, more than kMaxRays, or more than one turn. Angles and limits have
/// to be finite, and the increment not zero. A stated angle_max has to be within two steps of the last ray. In some
/// drivers it lies one step behind it. A message is refused, too, with a stamp before that of the last one, or of
/// another publisher. That lasts for kBinding: a clock that was set back counts from then on. A refused message is as
/// good as none.
///
/// The scan is silent if no message was accepted for kSilence, or if its stamps are older than that. It is blind
/// without one range that was measured, and frozen if the same ranges come again while the robot moved by kMoved.

#include <string>
#include <vector>

#include "navigation/scan.h"

namespace robot_control::navigation {

inline constexpr std::size_t kMaxRays = 20'000;
inline constexpr double kSilence = 0.5;  ///< s
inline constexpr double kBinding = 1;    ///< s
inline constexpr double kMoved = 0.05;   ///< m or rad

class ScanWatch {
 public:
  /// Returns why the message is refused; "" if it is taken. `stamp` and `now` are s on the clock of stamps, `moved` is
  /// the way that the robot has driven or turned so far, m + rad.
  std::string receive(const Scan& scan, const std::string& publisher, double stamp, double now, double moved);

  /// Returns why the newest scan does not count at this time; "" if it does.
  std::string problem(double now) const;

 private:
  std::string structure_problem(const Scan& scan) const;

  std::string publisher_, refused_ = "no scan has come: start the laser's driver, which publishes scan";
  double received_ = -1e9, stamp_ = -1e9;  // s
  std::vector<float> ranges_;
  double changed_at_ = 0, moved_ = 0;  // m + rad, when the ranges were last others; now
  bool blind_ = false;
};

}  // namespace robot_control::navigation
