#pragma once
/// Checks whether a laser can be trusted, from its messages alone.
///
/// A message is refused that has less than two rays, more than kMaxRays, or more than one turn. Angles and limits have
/// to be finite, and the increment not zero. A stated angle_max has to be within two steps of the last ray, because
/// some drivers state it one step too far. A message is also refused if its stamp is before that of the last one, or if
/// another publisher sent it. This ends kPublisherTimeout after the last accepted message, so that a clock may be set
/// back. A refused message counts as not received.
///
/// The scan is silent if no message was accepted for kScanTimeout, or if its stamps are older than that. It is blind
/// without one range that was measured, and frozen if the ranges stay the same while the robot moves by kFrozenMotion.

#include <string>
#include <vector>

#include "navigation/scan.h"

namespace robot_control::navigation {

inline constexpr std::size_t kMaxRays = 20'000;
inline constexpr double kScanTimeout = 0.5;     ///< s
inline constexpr double kPublisherTimeout = 1;  ///< s
inline constexpr double kMaxOdd = 0.01;         ///< of the rays; an echo at exactly range_max is rarer
inline constexpr double kFrozenMotion = 0.05;   ///< m or rad

/// Returns why a message with this scan is refused whatever was received before; "" if it is not.
std::string scan_problem(const Scan& scan);

class ScanWatch {
 public:
  /// Returns why the message is refused; "" if it is accepted. `stamp` and `now` are s on the clock of stamps, `moved`
  /// is how far the robot has driven and turned so far, m + rad.
  std::string receive(const Scan& scan, const std::string& publisher, double stamp, double now, double moved);

  /// Returns which rule of sensor_msgs/LaserScan the newest scan breaks although it counts; "" if it breaks none. At
  /// least kMaxOdd of its rays then have exactly range_max, or 0 with a range_min of 0.
  const std::string& remark() const noexcept { return remark_; }

  /// Returns why the newest scan does not count at this time; "" if it does.
  std::string problem(double now) const;

 private:
  std::string remark_on(const Scan& scan) const;

  std::string publisher_, remark_, refused_ = "no scan received: start the driver of the laser, which publishes scan";
  double received_ = -1e9, stamp_ = -1e9;  // s
  std::vector<float> ranges_;
  double changed_at_ = 0, moved_ = 0;  // m + rad, at the last change of the ranges; now
  bool blind_ = false;
};

}  // namespace robot_control::navigation
