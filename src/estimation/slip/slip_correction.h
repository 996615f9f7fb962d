#pragma once
/// The correction of the path in a slide, which lasts from the onset of slip to its end: explicit and bounded.
///
/// From the onset on, the line that E followed before is carried on (slide_line.h, motion_difference.h). What E leaves
/// it by is slip, and is taken off the path. Where one side rolls (slide_contacts.h), that side gives the path instead,
/// together with W, and renews the line by kLineGain. The speed stays between zero, that of the onset, and that of the
/// wheels. What a renewed line undoes of the correction leaves the path within the same bounds.
///
/// In a slide the speed is as uncertain as the line and the slope that is compared with it, and no more than its bounds
/// are apart, whether a side is taken to roll or not: a slope within a wide tolerance does not show that one rolls. The
/// errors of all decisions are alike, so the path's standard deviation is the integral of the speed's. A correction has
/// one of kCorrectionDeviation times itself besides.
///
/// A slide ends when all wheels have rolled for kRollingTime; when wheels and gyro have stood still as long and the
/// body brakes by no more than kSignificant slow errors of the accelerometer, as a robot at rest; or after
/// kLongestSlide without a side that rolls. Where the accelerometer shakes, the latter is kLongestShakenSlide, and the
/// whole correction is undone then: the slip was probably none. So it is where the robot has slid sideways on wheels
/// that all roll for longer than kLongestDrift: friction would have stopped it, but the accelerometer of a body that
/// leans shows a slide without end.

#include <algorithm>
#include <cstdint>
#include <utility>

#include "estimation/slip/slide_contacts.h"
#include "estimation/slip/slide_line.h"

namespace robot_control {

struct PathCorrection {
  Planar shift{};       ///< m, odom axes: to be added to the path
  double variance = 0;  ///< m²
};

class SlipCorrection {
 public:
  /// What is known in one step.
  struct Input {
    AccelerationNoise noise;
    double path_slope_deviation = 0;   ///< m/s, of E along, between two decisions
    double turn_slope_deviation = 0;   ///< m/s, of W, likewise
    double wheel_speed = 0;            ///< m/s, mean of both sides
    bool sensors_as_specified = true;  ///< false: the accelerometer shakes
  };

  /// Slip was proven that began `span` s ago at most.
  PathCorrection begin(const MotionDifference& difference, double span, const Input& input) noexcept;
  /// Every step in which both sides were read. The path is corrected once per point of the differences; where the
  /// wheels are early, a point is known later than it was added.
  PathCorrection step(const MotionDifference& difference, const Input& input) noexcept;
  /// Every step.
  void age(double dt) noexcept {
    since_end_ += active_ ? 0 : dt;
    undone_for_ = std::max(0.0, undone_for_ - dt);
  }
  void end() noexcept;
  /// The pose was set: what was corrected before is not undone, nor does a renewed line correct it.
  void begin_path(const MotionDifference& difference) noexcept;

  bool active() const noexcept { return active_; }
  double since_end() const noexcept { return since_end_; }                   ///< s
  std::uint64_t reasons() const noexcept { return active_ ? reasons_ : 0; }  ///< SlipReason
  const SlideContacts& contacts() const noexcept { return contacts_; }
  bool given_up() const noexcept { return given_up_; }      ///< the last slide, before its end
  bool undone() const noexcept { return undone_for_ > 0; }  ///< a correction was, Tuning::kUndoneTime ago at most
  const Planar& line_slope() const noexcept { return line_.slope(); }  ///< m/s, odom axes
  /// m/s, base axes: how much faster the wheels are than the ground, and how fast the robot slides to the left.
  double excess_speed() const noexcept { return excess_speed_; }
  double lateral_speed() const noexcept { return lateral_speed_; }
  double onset_speed() const noexcept { return onset_speed_; }  ///< m/s, along, before it slipped

 private:
  using Point = MotionDifference::Point;

  /// m, base axes, since the line is carried on: what the wheels rolled, what was taken off it, and the bounds of the
  /// rest.
  struct CarriedOn {
    double rolled = 0;
    Planar slipped{};
    double lowest = 0, highest = 0, farthest = 0;
  };

  void decide(const Point& to, const Input& input) noexcept;
  SlideContacts::Tolerance tolerance(const Input& input) const noexcept;
  bool stands(const Point& to, const Input& input) const noexcept;
  void renew_line(const Point& to, const Input& input, const DifferenceSlope& excess) noexcept;
  PathCorrection correct(const Point& to, const Input& input) noexcept;
  Planar undo(const Planar& slope_error, double time, double yaw) noexcept;
  std::pair<double, double> speed_bounds(double wheel_speed) const noexcept;  ///< m/s, along

  bool active_ = false;
  bool given_up_ = false;
  double undone_for_ = 0;  ///< s, for which that is still reported
  double since_end_ = 1e9;
  std::uint64_t reasons_ = 0;
  SlideContacts contacts_;
  SlideLine line_;
  Point corrected_;                              ///< of the last correction
  Point decided_;                                ///< of the last decision
  Planar path_slope_;                            ///< m/s, of E, odom axes, at the last decision
  double turn_slope_ = 0;                        ///< m/s, of W, likewise
  double path_begin_ = 0;                        ///< s, since which the path may be corrected
  double rolling_time_ = 0, standing_time_ = 0;  ///< s
  double sideways_time_ = 0;                     ///< s, on wheels that all roll
  double onset_speed_ = 0;
  double excess_speed_ = 0, lateral_speed_ = 0;
  Planar total_;               ///< m, odom axes, of this slide
  double path_deviation_ = 0;  ///< m, of this slide
  CarriedOn carried_on_;
};

}  // namespace robot_control
