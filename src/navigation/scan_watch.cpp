#include "navigation/scan_watch.h"

#include <algorithm>
#include <cmath>

#include "signals/formatted_text.h"

namespace robot_control::navigation {

std::string scan_problem(const Scan& scan) {
  const std::size_t rays = scan.ranges.size();
  if (rays < 2 || rays > kMaxRays) return formatted("scan has %zu rays: allowed are 2 to %zu", rays, kMaxRays);
  if (!std::isfinite(scan.angle_min) || !std::isfinite(scan.angle_increment) || scan.angle_increment == 0) {
    return formatted("scan has angle_min %g and angle_increment %g: both must be finite, the increment not zero",
                     scan.angle_min, scan.angle_increment);
  }
  constexpr double kTurn = 2 * M_PI + 0.1;  // rad
  if (std::abs(scan.angle_increment) * static_cast<double>(rays - 1) > kTurn) {
    return formatted("scan covers %.1f rad: allowed is one turn",
                     std::abs(scan.angle_increment) * static_cast<double>(rays - 1));
  }
  const double last = scan.angle(rays - 1);
  if (std::abs(scan.angle_max - last) > 2 * std::abs(scan.angle_increment)) {
    return formatted(
        "scan has angle_max %.3f rad, and its last ray is at %.3f rad: angle_min + angle_increment x (rays - 1)",
        scan.angle_max, last);
  }
  if (!std::isfinite(scan.range_max)) {
    return formatted("scan has range_max %g m: it must be finite: set range_max in the driver of the laser",
                     scan.range_max);
  }
  if (!(scan.range_min >= 0 && scan.range_min < scan.range_max)) {
    return formatted("scan has range_min %g m and range_max %g m: 0 <= range_min < range_max must hold", scan.range_min,
                     scan.range_max);
  }
  return "";
}

std::string ScanWatch::remark_on(const Scan& scan) const {
  const auto share = [&](double value) {
    const auto count = std::ranges::count(scan.ranges, static_cast<float>(value));
    return static_cast<double>(count) / static_cast<double>(scan.ranges.size());
  };
  if (const double at_max = share(scan.range_max); at_max >= kMaxOdd) {
    return formatted(
        "scan has exactly range_max (%g m) in %.0f %% of its rays, which counts as no echo: set +inf in the driver of "
        "the laser",
        scan.range_max, 100 * at_max);
  }
  if (const double zero = share(0); zero >= kMaxOdd && scan.range_min == 0) {
    return formatted(
        "scan has 0 m in %.0f %% of its rays and range_min 0 m; they count as not measured: set range_min in the "
        "driver "
        "of the laser",
        100 * zero);
  }
  return "";
}

std::string ScanWatch::receive(const Scan& scan, const std::string& publisher, double stamp, double now, double moved) {
  const auto refuse = [&](const std::string& why) { return refused_ = why; };
  if (const std::string why = scan_problem(scan); !why.empty()) return refuse(why);
  const bool bound = std::abs(now - received_) < kPublisherTimeout;
  if (bound && publisher != publisher_) {
    return refuse("scan has two publishers, " + publisher_ + " and " + publisher + ": stop one of them");
  }
  if (bound && stamp < stamp_) {
    return refuse(
        formatted("the stamps of scan go back by %.3f s: check the clock of the laser's computer", stamp_ - stamp));
  }
  blind_ = std::none_of(scan.ranges.begin(), scan.ranges.end(),
                        [&](float range) { return scan.hit(range) || scan.nothing(range); });
  const bool nothing =
      std::none_of(scan.ranges.begin(), scan.ranges.end(), [&](float range) { return scan.hit(range); });
  if (scan.ranges != ranges_ || nothing) changed_at_ = moved;
  ranges_ = scan.ranges;
  publisher_ = publisher, stamp_ = stamp, received_ = now, moved_ = moved;
  refused_.clear();
  remark_ = remark_on(scan);
  return "";
}

std::string ScanWatch::problem(double now) const {
  if (now - received_ > kScanTimeout) {
    return refused_.empty() ? formatted("no scan for %.1f s: check the laser and its driver", now - received_)
                            : refused_;
  }
  if (std::abs(now - stamp_) > kScanTimeout) {
    return formatted("the stamps of scan are %.1f s %s: check the clocks of laser and robot (chrony)",
                     std::abs(now - stamp_), now > stamp_ ? "old" : "ahead");
  }
  if (blind_) return "scan has no measured range: check whether the laser is covered";
  if (moved_ - changed_at_ > kFrozenMotion) return "scan is frozen: its ranges stay the same while the robot moves";
  return "";
}

}  // namespace robot_control::navigation
