#pragma once
/// The planar core estimates the pose in the plane. The gyro turns the robot, and the wheels move it. A Kalman filter
/// weighs the turn of the wheels against that of the gyro.
///
///   ψ ← ψ + (1 + κ)(gyro − b) dt    (x, y) ← (x, y) + d (cos ψ̄, sin ψ̄)    d: distance of the middle of the wheels
///
/// ψ̄ is the yaw halfway between two readings of the wheels, τ before their stamps: τ is the clock offset by which the
/// wheels are late. Without a gyro the wheels turn the robot. Once per block the turn of the wheels is compared with
/// that of the gyro:
///
///   right − left = B (1 + β)(ψ − ψ₀ − τ (ω − ω₀)) − ε s    s = (left + right)/2, B: effective wheel base of the model
///
/// The state is τ, x, y, ψ, ψ₀ (yaw at the beginning of the block), b (gyro bias), ε (radius_ratio − 1) and β
/// (wheel_base_factor − 1). Three further errors widen the covariance and are not corrected (S. F. Schmidt, 1966):
///
///   κ        scale of the gyro
///   x_ICR    centre of rotation ahead of the middle of the wheels: a turn dψ moves the middle by −x_ICR dψ sideways
///   radius   mean radius of the wheels, relative; it scales the path
///
/// The Jacobian by β contains the turn of the wheels, because that of the gyro contains a bias. Turns below
/// kSignificantTurn of their deviations do not show β. Wheels that a turn drags do not move the heading: load and floor
/// change ε and β as much as a gyro errs. Their blocks correct τ, ε and β alone, and the gyro's turn shows β. The
/// corrections of x, y, ψ, ψ₀ and b are held back as δ. P is what is known then, and δ is how far the state is from it.
/// The deviation of a state is that of P + δ δᵀ. A first rest measures b. It applies δ to the pose if that of the
/// heading exceeds kSignificant deviations of P. These hold the walk of the bias and the noise of the rest.
///
/// A correction moves the pose at once, and the shown pose by a low pass over kShowTime, so that odom does not jump.
///
/// An innovation beyond kHuber deviations widens its own to that. Beyond kGate deviations wheels and gyro contradict
/// each other. The heading then follows the gyro. Its doubt, a deviation beside P, grows by the angle between both.
/// Wheels that are dragged may turn the robot by any part of their own turn. Each block in which both agree takes
/// kAgreement of the doubt. Turns that drag wheels triple that.
/// ε and β walk in proportion to the slip noise (wheel_noise.h). The blocks that follow check them. If the
/// values of the start predict better, by a nis of kSignificant², ε and β begin again from these.

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "estimation/common/tuning.h"
#include "estimation/common/values.h"
#include "estimation/wheeled/planar/wheel_noise.h"
#include "signals/state_frame.h"

namespace robot_control {

struct PlanarPose {
  double x = 0, y = 0;  ///< m
  double yaw = 0;       ///< rad
};

struct PlanarCoreParams {
  double wheel_base = 0.5;                ///< m, effective
  double gyro_noise = 2.44e-4;            ///< rad/s/√Hz
  double gyro_bias_walk = 8.7e-6;         ///< rad/s/√s
  double gyro_bias_initial = 0.0175;      ///< rad/s
  double gyro_scale = 5.8e-4;             ///< standard deviation
  double encoder = 4.4e-5;                ///< m, of one reading
  double slip_least = 8e-5;               ///< m/√m, of the best floor
  bool drags_wheels = true;               ///< A turn drags wheels over the floor.
  double ratio_deviation = 0.01;          ///< 0: held
  double wheel_base_deviation = 0.03;     ///< 0: held
  double radius_deviation = 0;            ///< relative, of the wheels' mean radius
  double icr_deviation = 0;               ///< m, of the instantaneous centre of rotation along x; 0: between two wheels
  double clock_offset = Tuning::kOffset;  ///< s, standard deviation; 0: held
};

class PlanarCore {
 public:
  enum Index : int { kOffset, kX, kY, kYaw, kAnchor, kBias, kRatio, kBase, kScale, kIcr, kRadius, kSize };
  static constexpr int kHeld = 5;        ///< the states from x to the bias, whose corrections may be held back
  static constexpr int kConsidered = 3;  ///< the last states, which are considered and not corrected
  using Matrix = Eigen::Matrix<double, kSize, kSize>;
  using Vector = Eigen::Matrix<double, kSize, 1>;

  /// Describes the travel of both sides since the block began.
  struct Block {
    double time = 0, left = 0, right = 0;  ///< s, m
    double rate = 0;                       ///< rad/s, of the gyro at the end
    bool slid = false;                     ///< Wheels slipped: nothing is learned of them.
    bool stuck = false;                    ///< The gyro repeated one sample for longer than kMaxHoldTime.
  };
  struct Innovation {
    double nis = 0;
    bool used = false;
  };

  explicit PlanarCore(const PlanarCoreParams& params = {}) noexcept;

  void place(const PlanarPose& pose) noexcept;  ///< The pose is known exactly; all else stays.
  void set_bias(double bias, double deviation) noexcept;
  /// A deviation of 0 in the parameters holds its value.
  void set_calibration(const WheelCalibration& known) noexcept;
  void set_pose_covariance(const Eigen::Matrix3d& known) noexcept;  ///< covariance of x, y, yaw

  void turn_by_gyro(double angle, double dt) noexcept;  ///< rad, bias included
  /// The travel is in m; the robot has turned by `already` rad since the last readings.
  void turn_by_wheels(double left, double right, double already) noexcept;
  double wheel_turn(double left, double right) const noexcept;  ///< rad, by the calibration
  /// Moves the pose by x, y (m, odom axes) while the robot turns at `rate` rad/s.
  void roll(double x, double y, double rate) noexcept;
  void shift(double x, double y, double variance) noexcept;  ///< m, m²
  void add_yaw_variance(double variance) noexcept { (*covariance_)(kYaw, kYaw) += variance; }

  /// Begins a block when the travel of both sides has been read.
  void begin_block(double rate) noexcept;
  Innovation end_block(const Block& block) noexcept;
  /// Adds a contradiction of wheels and gyro by `angle` rad.
  void contradict(double angle) noexcept;
  /// Returns true if wheels and gyro contradict each other by more than kUnknownHeading.
  bool contradicted() const noexcept { return doubt_ > Tuning::kUnknownHeading; }
  /// Measures the bias by the gyro's mean at rest, rad/s. With `keeps_pose` the pose is not corrected.
  void rest(double mean, double variance, bool keeps_pose) noexcept;
  /// The shown pose follows the corrections for dt s.
  void show(double dt) noexcept { *hidden_ *= std::max(0.0, 1 - dt / Tuning::kShowTime); }
  void age(double dt) noexcept { (*covariance_)(kBias, kBias) += square(params_.gyro_bias_walk) * dt; }
  void open_bias(double variance) noexcept { (*covariance_)(kBias, kBias) += variance; }

  PlanarPose pose() const noexcept { return {(*state_)[kX], (*state_)[kY], (*state_)[kYaw]}; }
  PlanarPose shown_pose() const noexcept {
    return {(*state_)[kX] - (*hidden_)[0], (*state_)[kY] - (*hidden_)[1], (*state_)[kYaw] - (*hidden_)[2]};
  }
  double bias() const noexcept { return (*state_)[kBias]; }                        ///< rad/s
  double ratio() const noexcept { return (*state_)[kRatio]; }                      ///< ε
  double base() const noexcept { return (*state_)[kBase]; }                        ///< β
  double offset() const noexcept { return (*state_)[kOffset]; }                    ///< τ, s
  double turned() const noexcept { return (*state_)[kYaw] - (*state_)[kAnchor]; }  ///< rad, in this block
  double slip() const noexcept { return noise_.slip(); }                           ///< m/√m, learned
  WheelCalibration calibration() const noexcept {
    return {1 + ratio(), 1 + base(), deviation(kRatio), deviation(kBase)};
  }

  const Stored<Matrix>& covariance() const noexcept { return covariance_; }  ///< P, without doubt and held corrections
  Eigen::Matrix4d pose_covariance() const noexcept;  ///< covariance of τ, x, y, yaw as shown, with the doubt
  double variance(int i) const noexcept { return std::max(0.0, (*covariance_)(i, i)) + square((*held_)[i]); }
  double deviation(int i) const noexcept { return std::sqrt(variance(i)); }
  double bias_variance() const noexcept { return variance(kBias); }  ///< (rad/s)²

 private:
  void add(int to, double factor, int from) noexcept;
  void forget(int first, int count) noexcept;
  void slide(double turned) noexcept;
  void correct(Vector gain, const Vector& ph, double s, double innovation, int held) noexcept;
  void apply_held(int first, int count) noexcept;
  void compare(double angle, double wheels, double usual, bool agree, bool stuck) noexcept;
  void check_calibration(double learned, double other, double variance) noexcept;
  void walk(int i, double variance) noexcept {  ///< A held value has no variance and does not walk.
    if ((*covariance_)(i, i) > 0) (*covariance_)(i, i) += variance;
  }

  PlanarCoreParams params_;
  Stored<Vector> state_;
  Stored<Matrix> covariance_;
  Stored<Vector> held_;             ///< corrections that were not applied
  Stored<Eigen::Vector3d> hidden_;  ///< corrections of x, y, yaw that are not shown yet
  bool turned_ = false;             ///< The first rest has corrected the pose.
  WheelNoise noise_;
  WheelCalibration start_;                ///< calibration at the start
  double worse_ = 0;                      ///< nis by which what was learned predicts worse than the start
  double doubt_ = 0, apart_ = 0;          ///< rad: largest |apart_|; sum of the contradictions
  double doubted_x_ = 0, doubted_y_ = 0;  ///< m, where the doubt began
  double placed_x_ = 0, placed_y_ = 0;    ///< m, where the pose was set
  double anchor_x_ = 0, anchor_y_ = 0;    ///< m, where the block began
  double anchor_rate_ = 0;                ///< rad/s, at the beginning of the block
};

}  // namespace robot_control
