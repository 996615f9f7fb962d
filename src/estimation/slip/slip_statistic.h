#pragma once
/// Slip, found without the state of a filter, and the level of the residuals it is measured against.
///
///   E = way by wheels and gyro − twice integrated acceleration    (odom axes, gravity removed, of the middle of the
///   wheels; the lever of the IMU turned by the yaw)               W = right − left − B ψ
///
/// Without slip E is a straight line, whatever the speed at the beginning, and W a constant. Over spans of about T
///
///   D = (E₂ − E₁) − (E₁ − E₀) (t₂ − t₁)/(t₁ − t₀)    V = W₂ − W₁         T = 0.1, 0.2, 0.4, 0.8 s
///
/// are what slip, noise and vibration make. The deviations of D (in base axes, along and across) and V by what is known
/// of the sensors at best:
///
///   σ_D² = 6 encoder² + n² 2T³/3 + (slow T²)² + 2 kSlip² path
///   σ_V² = 4 encoder² + 2 kSlip² path + (B σ_β Δψ)² + (B wind-up)² |Δω| + (B σ_b T)²
///
/// Real floors shake an accelerometer thirty times harder than its data sheet says. So each T of each channel learns a
/// level: the 90 % quantile of |D|/σ_D, by steps of kStep on its logarithm (H. Robbins, S. Monro, A stochastic
/// approximation method, 1951), from the largest of the first kFirst; before that it is that of kFloor, a robot that
/// shakes. A robot that drives faster than usual shakes more: what exceeds the sensors' noise grows in proportion to
/// the speed. To that come (σ_τ Δspeed)² and (B σ_τ Δω)² of the clock offset (planar/planar_core.h); Δspeed: the lesser
/// one of wheels and accelerometer, because no offset bends E while the wheels keep their speed. Slip is proven where
/// |D| exceeds kProof of the deviations that belong to that quantile, and kSeconded of those of the next longer T: one
/// late stamp is as large in every T.

#include <array>
#include <cstdint>

#include "signals/geometry.h"

namespace robot_control {

struct SlipStatisticParams {
  double encoder = 4.4e-5;        ///< m, of one reading
  double accelerometer = 1.7e-3;  ///< m/s²/√Hz
  double wheel_base = 0.5;        ///< m
  double slip = 8e-5;             ///< m/√m
  double ahead = 0, aside = 0;    ///< m, of the IMU from the middle of the wheels
  double height = 0;              ///< m, of the IMU above the contacts
};

struct Planar {
  double x = 0, y = 0;
};

class SlipStatistic {
 public:
  enum Channel : std::size_t { kAlong, kAcross, kTurn, kChannels };
  static constexpr std::array<double, 4> kSpans{0.1, 0.2, 0.4, 0.8};  ///< s
  static constexpr double kGrid = 0.05;                               ///< s between two points

  struct Point {
    double time = 0;  ///< s
    Planar e;         ///< m, odom axes
    double w = 0;     ///< m
    double path = 0;  ///< m, always growing
    double yaw = 0;   ///< rad
    Planar speed;     ///< m/s, inertial, up to a constant
    double rate = 0;  ///< rad/s
  };

  struct Sample {
    double dt = 0;
    std::array<double, 2> acceleration{};  ///< m/s², base axes, without gravity
    Vector3 up{0, 0, 1};                   ///< base axes
    double turned = 0;                     ///< rad
    double yaw = 0;                        ///< rad, behind it
    Planar way;                            ///< m, odom axes, by the wheels in this step
    double across = 0;                     ///< m: right − left of this step, by the calibration as the turn of B
    double path = 0;                       ///< m, |left| + |right| over two
    bool read = false;                     ///< both sides were read in this step
    double rate = 0;                       ///< rad/s
  };

  /// What is known at a point.
  struct Doubts {
    std::array<double, 2> acceleration{};  ///< (m/s²)², variance of gravity and bias
    double base = 0.03;                    ///< standard deviation of the wheel base's factor
    double offset = 0;                     ///< s, of the clock offset
    double bias = 0;                       ///< rad/s, of the gyro
  };

  SlipStatistic() = default;
  explicit SlipStatistic(const SlipStatisticParams& params) noexcept;

  void restart() noexcept;  ///< E begins again
  /// It begins again behind a past on the straight line of this slope, m/s: of rest 0, behind a slide that ended the
  /// line that was carried on.
  void restart_on(const Planar& slope) noexcept;
  /// The robot stood until now.
  void stand(double yaw, const Vector3& up) noexcept {
    lever_ = lever(yaw, up);
    now_.speed = {};
    now_.yaw = yaw;
    now_.rate = 0;
    restart_on({});
  }
  /// The way until now is not to be corrected any more.
  void begin_path() noexcept { path_began_ = now_.time; }
  double path_began() const noexcept { return path_began_; }  ///< s
  /// True: a point was added.
  bool step(const Sample& sample) noexcept;
  /// At a point. `learns`: no slip is going on.
  void judge(const Doubts& doubts, bool learns) noexcept;

  bool proven(Channel channel) const noexcept { return proven_[channel] > 0; }
  double span(Channel channel) const noexcept { return proven_[channel]; }  ///< s, the shortest that proved it
  const Point& now() const noexcept { return now_; }
  const Point& last() const noexcept { return points_[(count_ - 1) % kPoints]; }
  const Point& before(double time) const noexcept;  ///< the newest point no later than that
  bool empty() const noexcept { return count_ == 0; }

  /// Residuals along over what the sensors' noise explains, at T = 0.2 s; 0: nothing was compared yet.
  double level() const noexcept;
  /// Noise of the acceleration while it drives: white (m/s²/√Hz) and slow (m/s²), as learned.
  double white() const noexcept;
  double slow(double acceleration_variance) const noexcept;
  bool calm() const noexcept;  ///< its sensors are as good as they are taken for
  /// Of the last judgement: by how much gravity seems to be too small, along and across, and its variance; of T = 0.4.
  struct Pull {
    bool known = false;
    double along = 0, across = 0, variance = 0, interval = 0;
  };
  const Pull& pull() const noexcept { return pull_; }
  /// m/s: deviation of a slope over T = 0.1 s, as learned, at the last judgement.
  double slope_deviation(Channel channel) const noexcept { return slope_[channel]; }
  /// What was taken for slip was none: the levels are those that explain it.
  void learn_false() noexcept;
  double nis(Channel channel) const noexcept { return nis_[channel]; }  ///< of the last judgement; < 0: none

 private:
  static constexpr std::size_t kPoints = 64;
  static constexpr std::size_t kCount = kSpans.size();
  struct Second {
    bool known = false;
    double span = 0, path = 0, turned = 0, changed = 0, gained = 0;
    std::array<double, kChannels> d{};
    double speed() const noexcept { return path / (2 * span); }  ///< m/s
  };
  struct Noise {
    double white = 0, slow = 0, jitter = 0, slip = 0;
  };
  /// What skid steers, a vacuum cleaner and a car show.
  static constexpr Noise kFloor{.white = 0.065, .slow = 0.2, .jitter = 0.005, .slip = 5e-3};
  Second second_difference(double span) const noexcept;
  double deviation(std::size_t channel, const Second& second, const Noise& noise, const Doubts& doubts) const noexcept;
  /// Of T at a speed, m/s: what shakes a robot grows with its speed beyond that at which the level was learned.
  double at_speed(double level, double speed) const noexcept;
  double expected(std::size_t span, std::size_t channel, const Second& second, const Doubts& doubts) const noexcept;
  void learn(std::size_t span, const Second& second, const Doubts& doubts) noexcept;
  Noise best() const noexcept;
  Planar lever(double yaw, const Vector3& up) const noexcept;

  SlipStatisticParams params_;
  std::array<Point, kPoints> points_{};
  std::size_t count_ = 0;
  Point now_;
  Planar inertial_;  ///< m, twice integrated
  Planar before_;
  Planar lever_;                                               ///< m, odom axes, of the IMU
  std::array<std::array<double, kChannels>, kCount> level_{};  ///< 0: unknown
  std::array<std::array<double, kChannels>, kCount> largest_{};
  std::array<std::array<std::uint64_t, kChannels>, kCount> seen_{};
  std::array<double, kCount> learned_at_{};
  std::array<double, kChannels> proven_{};
  std::array<double, kChannels> nis_{};
  std::array<double, kChannels> slope_{};
  std::array<std::array<double, kChannels>, kCount> onset_{};  ///< |D|/σ of the last proof
  Pull pull_;
  double pulled_at_ = 0;
  double usual_speed_ = 0;  ///< m/s, at which the levels are learned
  double speed_ = 0;        ///< m/s, at the last judgement
  double path_began_ = 0;   ///< s
};

}  // namespace robot_control
