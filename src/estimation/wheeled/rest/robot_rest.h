#pragma once
/// Finds the rests of a run by successive windows (rest_watch.h) and holds the motion that is not integrated meanwhile.
///
/// A run begins at rest until a window is not quiet. At rest the motion of a window is held until the next window is
/// quiet, too. If a window is not quiet, the motion of the last two is returned, to be integrated at once.

#include <optional>

#include "estimation/common/values.h"
#include "estimation/wheeled/rest/rest_watch.h"

namespace robot_control {

/// Holds the motion that wheels and gyro measured in some time.
struct HeldMotion {
  double time = 0;             ///< s
  double left = 0, right = 0;  ///< m
  Vector3 turn{};              ///< rad, base axes, gyro bias included
  Planar velocity{};           ///< m/s, base axes, integral of the acceleration
  bool gyro = true;            ///< The gyro was present all the time.

  void add(const HeldMotion& other) noexcept {
    time += other.time;
    left += other.left;
    right += other.right;
    for (std::size_t i = 0; i < 3; ++i) turn[i] += other.turn[i];
    velocity = velocity + other.velocity;
    gyro = gyro && other.gyro;
  }
};

class RobotRest {
 public:
  explicit RobotRest(const RestWatchParams& params) noexcept : steady_(params.steady), watch_(params) {}

  struct Input {
    RestWatch::Sample sample;
    std::optional<Vector3> rate{};  ///< rad/s, of the gyro, also in a short silence
    Planar acceleration{};          ///< m/s², base axes, without gravity
    bool any_lost = false;          ///< The wheels of a side are lost.
    bool fell_silent = false;       ///< Both sides are lost and had brought readings.
    Vector3 bias{};                 ///< rad/s, of the gyro
    Vector3 bias_variance{};        ///< (rad/s)²
    double mean_variance = 0;       ///< (rad/s)², noise of a window's mean
  };
  struct Output {
    bool began = false;                       ///< The robot has come to rest.
    std::optional<HeldMotion> held{};         ///< The rest is over, and this motion is to be integrated.
    bool was_standing = false;                ///< The rest that is over was confirmed by a quiet window.
    std::optional<RestWatch::Means> means{};  ///< means of a quiet window, from which biases and tilt are learned
    bool bias_changed = false;                ///< They show another bias of the gyro than an earlier rest.
  };
  Output step(const Input& input) noexcept;

  /// Continues an earlier process, which had rested.
  void resume() noexcept {
    resting_ = false;
    rested_ = moved_ = true;
  }
  void forget_held() noexcept { open_ = last_ = {}; }

  bool resting() const noexcept { return resting_; }
  bool standing() const noexcept { return standing_; }            ///< A quiet window has confirmed the rest.
  bool bias_measured() const noexcept { return bias_measured_; }  ///< A rest of this run has shown the gyro's bias.
  bool rested() const noexcept { return rested_; }                ///< A rest was seen in this run and is over.

 private:
  Output close(RestWindow window) noexcept;
  RestWatch::Bias bias(const Input& input) const noexcept;
  Output learn(bool began) noexcept;

  double steady_;  ///< rad/s
  RestWatch watch_;
  HeldMotion open_;  ///< motion in the window that is not over yet
  HeldMotion last_;  ///< motion in the window before
  bool resting_ = true;
  bool standing_ = false;
  bool bias_measured_ = false;
  bool rested_ = false;
  bool moved_ = false;
};

}  // namespace robot_control
