#pragma once
/// Watches for slip in motion: the detector proves its onset (slip_detector.h), and the slide lasts until all wheels
/// roll again (wheel_slide.h). Without slip it compares the acceleration of the wheels with gravity.
///
/// Its axes are those of odom without the corrections of the yaw, which would bend the integrated path.

#include <array>
#include <cstdint>

#include "estimation/slip/slip_detector.h"
#include "estimation/slip/wheel_slide.h"

namespace robot_control {

class SlipWatch {
 public:
  explicit SlipWatch(const SlipParams& params) noexcept : detector_(params), wheel_base_(params.wheel_base) {}

  /// Describes one step.
  struct Input {
    MotionDifference::Sample motion;     ///< without `yaw`; its path is in base axes at the end of the step
    std::array<double, 2> side_speed{};  ///< m/s, of the treads
    double clock_offset = 0;             ///< s, by which the wheels are late
    SlipUncertainty uncertainty;
    bool corrects = true;  ///< A slide may begin, because the accelerometer's bias is known.
  };
  struct Output {
    bool judged = false;                                ///< The members below are those of a new judgement.
    std::array<double, SlipResidual::kChannels> nis{};  ///< < 0: unknown
    SlipDetector::GravityError gravity;                 ///< known only while nothing slips
    WheelSlide::Correction correction;                  ///< The shift is in base axes.
    bool sideways_began = false;                        ///< A slide has begun sideways.
  };
  Output step(const Input& input) noexcept;

  void restart() noexcept;  ///< forgets a slide and all motion; the levels stay
  /// Restarts at the end of a rest. `velocity` (m/s, base axes) is the acceleration integrated since then.
  void restart_at_rest(const Vector3& up, const Planar& velocity) noexcept;
  /// States that the pose was set: the path before is not corrected any more.
  void begin_path() noexcept { detector_.begin_path(); }
  void end_slide() noexcept { slide_.end(); }

  const WheelSlide& slide() const noexcept { return slide_; }
  double level() const noexcept { return detector_.levels().level(); }  ///< ResidualLevels::level

 private:
  void evaluate(const Input& input, Output& output) noexcept;
  WheelSlide::Input slide_input(const Input& input) const noexcept;

  SlipDetector detector_;
  WheelSlide slide_;
  double wheel_base_;  ///< m
  double yaw_ = 0;     ///< rad, by the gyro alone
};

}  // namespace robot_control
