#pragma once
/// The correction of the way while wheels slip: explicit and bounded.
///
/// From the onset on, E's earlier line is continued (slip_statistic.h): what E leaves it by is slip, and is taken off
/// the way. A side that rolls, because E keeps to that line within its doubts and does not bend, as friction bends it,
/// gives the way instead, with W, and renews the line. The speed stays between zero, that of the onset, and that of the
/// wheels. The slide ends when both sides keep to the line for kAgreed, when wheels stand and the body does not brake,
/// which shows that the robot stands, or after kLongest without a side that rolls; where the accelerometer shakes, all
/// of the correction is taken back then. A correction is uncertain by kUncertain of itself.

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "estimation/slip/slip_statistic.h"

namespace robot_control {

class SlipCorrection {
 public:
  static constexpr double kLongest = 6.0;        ///< s, without a side that rolls
  static constexpr double kLongestShaken = 1.5;  ///< s, likewise, where the accelerometer shakes
  static constexpr double kTakenBack = 5.0;      ///< s
  static constexpr double kUncertain = 0.5;      ///< of a correction of the path: its standard deviation

  bool active() const noexcept { return active_; }
  double since_end() const noexcept { return since_end_; }  ///< s
  std::uint64_t reasons() const noexcept { return active_ ? reasons_ : 0; }
  bool left() const noexcept { return slips_[0]; }
  bool right() const noexcept { return slips_[1]; }
  bool sideways() const noexcept { return sideways_; }
  bool taken_back() const noexcept { return taken_back_ > 0; }  ///< all of a correction, kTakenBack ago at most
  bool gave_up() const noexcept { return gave_up_; }            ///< the last one ended by kLongest

  struct Step {
    double x = 0, y = 0;  ///< m, odom axes: to be added to the way
    double variance = 0;  ///< m²
  };

  struct Known {
    double white = 0, slow = 0;  ///< m/s²/√Hz, m/s²: of the acceleration
    double along = 0, turn = 0;  ///< m/s: deviation of the slopes of E and W over a decision
    double speed = 0;            ///< m/s, of the wheels
    bool calm = true;            ///< the accelerometer is as good as it is taken for
  };

  /// Slip was proven `span` s ago at most.
  Step begin(const SlipStatistic& statistic, double span, const Known& known) noexcept;
  /// Every step in which both sides were read.
  Step step(const SlipStatistic& statistic, const Known& known) noexcept;
  /// Every step.
  void age(double dt) noexcept {
    since_end_ += active_ ? 0 : dt;
    taken_back_ = std::max(0.0, taken_back_ - dt);
  }
  void end() noexcept;
  /// The pose was set: what was corrected before is not taken back, and no line is renewed behind it.
  void begin_path(const SlipStatistic& statistic) noexcept;
  void reset() noexcept { *this = SlipCorrection(); }
  const Planar& line() const noexcept { return line_; }  ///< m/s
  /// m/s, base axes: how much faster the wheels are than the ground, along; and how the robot slides across.
  double excess() const noexcept { return excess_; }
  double aside() const noexcept { return aside_; }
  double onset_speed() const noexcept { return onset_speed_; }  ///< m/s, along, before it slipped

 private:
  /// m/s, base axes, of E and W.
  struct Slope {
    double along = 0, across = 0, turn = 0;
    double side(std::size_t i) const noexcept { return along + (i == 0 ? -1 : 1) * turn / 2; }
  };

  Step travel(const SlipStatistic::Point& to, const Known& known) noexcept;
  void decide(const SlipStatistic::Point& to, const Known& known) noexcept;
  std::pair<double, double> bounds(const Known& known) const noexcept;  ///< m/s, of the speed along
  double size() const noexcept;                                         ///< m², of the total squared
  double speed_deviation(const Known& known) const noexcept;
  void judge_contacts(const Known& known, const Slope& off, const Slope& bend) noexcept;
  bool stands(const SlipStatistic::Point& to, const Known& known, double dt) const noexcept;
  void renew_line(const SlipStatistic::Point& to, const Known& known, const Slope& off) noexcept;
  void name_reasons(const Known& known, double left, double right) noexcept;
  /// By how much the wheels are ahead of the ground, of that of both sides together and that of their turn.
  double slipped(double along, double turn) const noexcept;

  bool active_ = false;
  bool gave_up_ = false;
  double taken_back_ = 0;  ///< s, for which that is still said
  double since_end_ = 1e9;
  std::uint64_t reasons_ = 0;
  std::array<bool, 2> slips_{};
  bool sideways_ = false;
  SlipStatistic::Point from_;    ///< of the last correction
  SlipStatistic::Point looked_;  ///< of the last decision
  Planar line_;                  ///< m/s, slope of E without slip
  Planar slope_;                 ///< m/s, of E at the last decision
  double turn_ = 0;              ///< m/s, slope of W likewise
  double path_began_ = 0;        ///< s
  double anchored_ = 0;          ///< s, time since which the line has been carried on
  double agreed_ = 0, stood_ = 0;
  double onset_speed_ = 0;       ///< m/s, along
  double least_ = 0, most_ = 0;  ///< m/s
  double excess_ = 0, aside_ = 0;
  double onset_deviation_ = 0;  ///< m/s
  Planar total_;
  double counted_ = 0;  ///< m², variance that was given out since the anchor
};

}  // namespace robot_control
