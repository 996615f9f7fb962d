#pragma once
/// Proof of slip that needs no state of a filter, and the level of the residuals it is measured against.
///
/// For each side, and sideways, E is the travel by the wheels minus the twice integrated acceleration (gravity and the
/// robot's turning removed). Without slip E is a straight line, whatever the speed at the beginning; its second
/// difference over two spans of about T,
///
///   D = (E₂ − E₁) − (E₁ − E₀) (t₂ − t₁)/(t₁ − t₀)         T = 0.1, 0.2, 0.4, 0.8 s
///
/// is what slip, noise and vibration make. Its deviation, by what is known of the sensors at best:
///
///   σ² = 6 encoder² + n² 2T³/3 + (slow T²)² + 2 kSlip² path + 6 (jitter · speed)²
///
/// Real floors shake an accelerometer thirty times harder than its data sheet says. So each T learns a level: the 90 %
/// quantile of |D|, by steps of kStep on its logarithm (H. Robbins, S. Monro, A stochastic approximation method, 1951),
/// from the largest of the first kFirst; before that it is that of kFloor, a robot that shakes. Slip is proven where
/// |D| exceeds kProof of the deviations that belong to that quantile, and kSeconded of those of the next longer T: one
/// late stamp is as large in every T.

#include <array>
#include <cstdint>

#include "signals/geometry.h"

namespace robot_control {

struct SlipEvidenceParams {
  double encoder = 4.4e-5;        ///< m, of one reading
  double accelerometer = 1.7e-3;  ///< m/s²/√Hz
  double half_base = 0.25;        ///< m
  double ahead = 0, aside = 0;    ///< m, of the IMU from the middle of the wheels
};

class SlipEvidence {
 public:
  static constexpr std::array<double, 4> kSpans{0.1, 0.2, 0.4, 0.8};  ///< s
  /// Of D beside the encoder: what the sensors are capable of, and what skid steers, a vacuum cleaner and a car show.
  struct Noise {
    double white = 0;   ///< m/s²/√Hz
    double slow = 0;    ///< m/s²: tilt by a suspension, scale
    double jitter = 0;  ///< s, of stamps
  };
  static constexpr Noise kFloor{.white = 0.065, .slow = 0.2, .jitter = 0.005};
  static constexpr double kSlow = 0.02;  ///< m/s², what no inertial sensor on a moving robot knows better
  static constexpr double kSlip = 2e-3;  ///< m/√m
  static constexpr double kStep = 0.5;
  static constexpr std::uint64_t kFirst = 8;
  static constexpr double kProof = 5;  ///< deviations
  static constexpr double kSeconded = 3;
  static constexpr double kLasts = 0.3;  ///< s, of a proof
  static constexpr double kGrid = 0.05;  ///< s between two points of E

  struct Sample {
    double dt = 0;
    Vector3 force{};             ///< m/s², accelerometer, base axes
    Vector3 up{0, 0, 1};         ///< base axes
    double rate = 0;             ///< rad/s, bias removed
    double left = 0, right = 0;  ///< m, travel in this step; counted when both were read
    bool read = false;           ///< both sides were read in this step, or since the last time
    bool inertial = false;       ///< gyro and accelerometer are there
    double speed = 0;            ///< m/s, by the wheels
  };

  explicit SlipEvidence(const SlipEvidenceParams& params) noexcept : params_(params) { reset(); }

  void reset() noexcept;    ///< levels, too
  void restart() noexcept;  ///< E begins again
  void step(const Sample& sample) noexcept;

  bool proven() const noexcept { return since_ < kLasts; }
  double since_proof() const noexcept { return since_; }                      ///< s
  std::uint64_t reasons() const noexcept { return proven() ? reasons_ : 0; }  ///< SlipReason bits
  /// Residuals of both sides over what the sensors' noise explains, at T = 0.2 s; 0: nothing was compared yet.
  double level() const noexcept { return level_; }
  /// White noise of the accelerometer while the robot moves over that of its data sheet, from the median of the
  /// differences between two samples; shaken until it has driven for some seventy of them.
  double vibration() const noexcept;
  /// By how much the acceleration seems to be wrong, along and across, m/s²: new when `corrected`.
  bool corrected() const noexcept { return corrected_; }
  double along() const noexcept { return along_; }
  double across() const noexcept { return across_; }
  double interval() const noexcept { return interval_; }  ///< s, that this correction stands for

 private:
  static constexpr std::size_t kChannels = 3;  ///< left, right, sideways
  static constexpr std::size_t kPoints = 48;
  struct Point {
    double time = 0;
    std::array<double, kChannels> e{};
    double path = 0;
  };
  struct Second {
    bool known = false;
    double span = 0;
    double path = 0;
    std::array<double, kChannels> d{};
  };

  void judge() noexcept;
  void follow_vibration(const Sample& sample) noexcept;
  Second second_difference(double span) const noexcept;
  const Point& point_before(double time) const noexcept;
  double deviation(double span, double path, const Noise& noise) const noexcept;
  double expected(std::size_t span, std::size_t channel, const Second& second) const noexcept;
  void learn(std::size_t span, const Second& second) noexcept;
  void prove(std::size_t channel) noexcept;
  void correct_tilt(const Second& second) noexcept;

  SlipEvidenceParams params_;
  std::array<Point, kPoints> points_;
  std::size_t count_ = 0;  ///< points so far
  double time_ = 0;
  std::array<double, kChannels> e_{};
  double forward_ = 0, sideways_ = 0;  ///< m/s, inertial
  double path_ = 0;
  std::array<std::array<double, kChannels>, kSpans.size()> log_level_{};  ///< of deviation over that of the data sheet
  std::array<std::array<double, kChannels>, kSpans.size()> largest_{};    ///< deviations of the data sheet
  std::array<std::uint64_t, kSpans.size()> seen_{};                       ///< windows that were learned from
  std::array<double, kSpans.size()> learned_at_{};                        ///< s
  double since_ = 1e9;
  std::uint64_t reasons_ = 0;
  double level_ = 0;
  double log_vibration_ = 0;
  Vector3 last_force_{};  ///< m/s²
  double force_age_ = 0;  ///< s
  bool corrected_ = false;
  double along_ = 0, across_ = 0, interval_ = 0;
};

}  // namespace robot_control
