#pragma once
/// Error-state Kalman filter of a wheeled robot with an IMU, in three dimensions.
///
/// The nominal state is integrated through the full equations; the covariance is that of its small error, and every
/// correction is folded into the nominal state at once (J. Solà, Quaternion kinematics for the error-state Kalman
/// filter, arXiv:1711.02508, chapters 5 and 6; the orientation's error is in world axes, ibid. chapter 7).
///
///   nominal state                                            error (index)
///   p    m      IMU in odom                                  kPosition      3
///   R           base axes to odom axes, z against gravity    kOrientation   3   R_true = Exp(θ) R
///   u    m/s    velocity of the IMU, base axes               kVelocity      3
///   s    m      travel of the left and the right wheels      kTravel        2   as the model's radii measure it
///   bg   rad/s  gyro bias, base axes                         kGyroBias      3
///   ba   m/s²   accelerometer bias, base axes                kAccelerometerBias 3
///   ε           radius_ratio − 1                             kRadiusRatio   1
///   β           wheel_base_factor − 1                        kWheelBase     1
///   κ           gyro scale error, not published              kGyroScale     1
///
/// Prediction, with ω = (1 + κ)(gyro − bg) and f = accelerometer − ba, gravity g:
///   ṗ = R u      Ṙ = R [ω]×      u̇ = f + Rᵀ g − ω × u
///   ṡ_i = (c_i + χ |c_i| f_x) / (1 ∓ ε/2), left −, right +     c_i = (u + ω × r_i)_x
/// r_i from the IMU to where wheel i touches the ground: the encoder measures the wheel against the body, so that a
/// pitching body enters with the height of the contact. Its lateral component is ±(1 + β)/2 of the effective wheel
/// base. A tyre that pulls or holds creeps: its tread slides by χ f per speed, against the specific force f on the
/// robot, along as across (H. B. Pacejka, Tire and Vehicle Dynamics, 2012, chapter 3, linear range). f is that of the
/// middle between the contacts, without the part of gravity that is uncertain: a tilt within 3 σ makes no creep. The
/// Jacobian leaves creep out, χ f is some thousandths.
///
/// The columns of ε, β and κ take the gyro's rate of a while ago, smoothed over kSmoothing and again over kWindUp: its
/// noise, in both the column and the innovation, would bias them (errors in variables; W. Fuller, Measurement Error
/// Models, 1987, section 1.1). Smoothed once it took β off by 0.1 in 20 s straight on, smoothed twice by 0.05 in 60 s:
/// a rate within kTurns deviations of its noise and 3 of the bias counts as none.
///
/// Measurements, one scalar after another (Y. Bar-Shalom, X. R. Li, T. Kirubarajan, Estimation with Applications to
/// Tracking and Navigation, 2001, sections 5.4 and 10.2: gate and normalised innovation squared):
///   encoder angles         s_i = travel measured: angles, so that a count is an error once, not once per cycle
///   contact                (u + ω × r_c)_y = −χ |c_x| f_y, (u + ω × r_c)_z = 0 at the middle c of the contacts
///                          (non-holonomic constraint; G. Dissanayake et al., The aiding of a low-cost strapdown
///                          inertial measurement unit using vehicle model constraints, IEEE T-RA 17(5), 2001,
///                          section III)
///   standstill             gyro = bg; accelerometer = ba − Rᵀ g (zero rotation and zero velocity; P. D. Groves,
///                          Principles of GNSS, Inertial, and Multisensor Integrated Navigation Systems, 2013, 15.3)
///   rolling                acceleration = accelerometer − ba + Rᵀ g, over a window in which everything rolled
/// Encoders and contact consider tilt, accelerometer bias and gyro scale and do not correct them (Schmidt's gain, see
/// `correct`): rolling does not distinguish the scale from the wheel base. The vertical contact corrects the velocity
/// alone. What is learned at rest leaves base_link where it is. Encoders and contact pull no harder than Huber's bound.
///
/// A tyre winds up before it rolls, 0.4 mm by 20 N at 50 kN/m, and on wheels 0.5 m apart 1.6 mrad: noise of the wheels'
/// turn where its rate changes. On a slope χ matters, which is known to no better than a half, and no two tyres have
/// the same: beyond what the tilt is known to (3 σ), the travel of both gets slope_creep times the slope as noise, that
/// of either slope_slip.
///
/// Without a gyro sample the robot turns as the calibrated wheels do, and level; without an accelerometer sample its
/// velocity is carried on, with an acceleration of kUnknownAcceleration as noise.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <span>

#include "robot/gravity.h"

namespace robot_control {

/// Lever arms from the IMU, base axes.
struct ContactGeometry {
  double wheel_base = 1;                 ///< m, effective, of the model
  double middle_y = 0;                   ///< m, middle between left and right contacts
  double middle_x = 0;                   ///< m, middle of the axles
  double height = 0;                     ///< m, of the contacts; below the IMU negative
  Eigen::Vector3d imu_in_base{0, 0, 0};  ///< m
  double creep = 0;                      ///< s²/m, χ of the tyres
};

/// White noises are densities, walks per √s; deviations are standard deviations.
struct FilterNoise {
  double gyro = 2.5e-4;                   ///< rad/s/√Hz
  double gyro_bias_walk = 1e-5;           ///< rad/s/√s
  double accelerometer = 2e-3;            ///< m/s²/√Hz
  double accelerometer_bias_walk = 1e-4;  ///< m/s²/√s
  double wheel_slip = 8e-5;               ///< m/√m of each side's travel, of either wheel alone
  double common_slip = 5e-5;              ///< m/√m, of both together; up to kCautious times that near sliding
  double encoder = 4.4e-5;                ///< m, of one reading
  double turn_slip = 5e-4;                ///< rad/√rad, of the wheels' turn: a contact patch twists before it turns
  double slope_slip = 0.01;               ///< m/√m per sine of the slope, of either wheel alone
  double slope_creep = 0.05;              ///< m/√m per sine of the slope, of both together
  double wind_up = 1.6e-3;                ///< rad/√(rad/s), of the wheels' turn where its rate changes
  double radius_ratio_walk = 3e-6;        ///< 1/√m
  double wheel_base_walk = 2e-5;          ///< 1/√m: load and floor change how a tyre turns
  double lateral = 5e-4;                  ///< m/s/√Hz, sideways at the contact
  double vertical = 5e-3;                 ///< m/s/√Hz
};

/// Of the start.
struct FilterPrior {
  double tilt = 0.1;                ///< rad
  double gyro_bias = 0.05;          ///< rad/s
  double accelerometer_bias = 0.2;  ///< m/s²
  double radius_ratio = 0.01;
  double wheel_base = 0.03;
  double gyro_scale = 1e-3;
};

class ErrorStateFilter {
 public:
  enum Index : int {
    kPosition = 0,
    kOrientation = 3,
    kVelocity = 6,
    kTravel = 9,
    kGyroBias = 11,
    kAccelerometerBias = 14,
    kRadiusRatio = 17,
    kWheelBase = 18,
    kGyroScale = 19,
    kSize = 20,
  };
  using Covariance = Eigen::Matrix<double, kSize, kSize>;
  using Column = Eigen::Matrix<double, kSize, 1>;

  static constexpr double kGravity = robot_control::kGravity;
  static constexpr double kCautious = 15;       ///< times: 0.75 mm/√m, the creep of a wheel about to slide
  static constexpr double kSliding = 0.03;      ///< m/s²/√Hz more, while no wheel holds the velocity: it shakes
  static constexpr double kSmoothing = 0.05;    ///< s
  static constexpr double kWindUp = 0.1;        ///< s; of the rate of a while ago, too
  static constexpr double kTurns = 10;          ///< σ
  static constexpr double kPulledBias = 0.005;  ///< m/s²
  static constexpr double kUnknownAcceleration = 1.0;  ///< m/s²/√Hz, of a robot without accelerometer

  /// What moved the robot over `dt`. Base axes.
  struct Motion {
    double dt = 0;                                 ///< s
    std::optional<Eigen::Vector3d> gyro;           ///< rad/s, mean over dt, bias included
    std::optional<Eigen::Vector3d> accelerometer;  ///< m/s², mean over dt, bias included
    double left_travel = 0, right_travel = 0;      ///< m over dt, as the model's radii measure it
    double slip_proximity = 0;                     ///< 0 … 1: the wheels may be about to slide
    bool sliding = false;                          ///< no wheel holds the velocity
    double left_speed = 0, right_speed = 0;        ///< m/s, smoothed
  };

  /// At rest the position does not move by what is learned, nor the yaw but when rest begins: then it learns what the
  /// gyro's bias had made of it on the way.
  enum class Rest { kBegins, kGoesOn };

  /// What a wheel's travel corrects: where it may be sliding, neither calibration nor the gyro's bias.
  enum class Scope { kAll, kMotion };

  /// A scalar measurement's innovation over its deviation, squared.
  struct Innovation {
    double nis = 0;
    bool used = false;
  };

  ErrorStateFilter(const ContactGeometry& geometry, const FilterNoise& noise, const FilterPrior& prior);

  void reset() noexcept;
  void predict(const Motion& motion) noexcept;

  Innovation correct_travel(int side, double travel, Scope scope = Scope::kAll) noexcept;
  Innovation correct_lateral(double dt) noexcept;
  Innovation correct_vertical(double dt) noexcept;
  /// Measured: by how much the acceleration along a base axis is more than accelerometer − ba + Rᵀ g. m/s²
  /// As it was when the robot had yet to turn by `turned` rad.
  Innovation correct_acceleration(int axis, double excess, double variance, double turned) noexcept;
  /// `mean` over `time` s at rest. No gate: the caller judged them quiet.
  Innovation correct_gyro_at_rest(int axis, double mean, double variance, Rest rest) noexcept;
  Innovation correct_accelerometer_at_rest(int axis, double mean, double variance) noexcept;

  /// The robot stands: the velocity is zero, known to `deviation` m/s.
  void stand(double deviation) noexcept;
  /// The wheels stand, the body turns about their contacts by `turning` rad/s, base axes, known to `deviation`: that is
  /// the velocity.
  void rock(const Eigen::Vector3d& turning, double deviation) noexcept;
  /// The robot has come to rest: the velocity is measured to be zero, which corrects errors made on the way.
  void halt(double deviation) noexcept;
  /// Biases walk for `dt` s while nothing is predicted.
  void age(double dt) noexcept;
  /// m/s², base axes: what an error of bias and tilt makes of accelerometer − ba + Rᵀ g.
  Eigen::Vector3d acceleration_by(const Column& error) const noexcept;
  /// m/s², per base axis: of accelerometer − ba + Rᵀ g, through bias and tilt.
  Eigen::Vector3d acceleration_deviation() const noexcept;
  /// The wheels of that side restart at `travel`.
  void anchor_travel(int side, double travel) noexcept;
  void turn_by(const Eigen::Vector3d& angle) noexcept;  ///< base axes, rad

  /// Adds an error to the nominal state; what a window of corrections did is taken back by its negative.
  void inject(const Column& error) noexcept;
  /// The velocity along a base axis has been wrong by `deviation` m/s for `time` s, and has pulled on the
  /// accelerometer's bias, which is from now on known to kPulledBias at best.
  void inflate_velocity(int axis, double deviation, double time) noexcept;
  void inflate_position(int axis, double deviation) noexcept;  ///< m, along a base axis
  /// Sum of all errors injected by measurements since the last prediction.
  const Column& corrections() const noexcept { return corrections_; }

  Eigen::Vector3d position{0, 0, 0};
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d velocity{0, 0, 0};
  Eigen::Vector2d travel{0, 0};
  Eigen::Vector3d gyro_bias{0, 0, 0};
  Eigen::Vector3d accelerometer_bias{0, 0, 0};
  double radius_ratio = 0;
  double wheel_base = 0;
  double gyro_scale = 0;
  Covariance covariance;

  Eigen::Vector3d rate{0, 0, 0};  ///< rad/s, bias-free, of the last prediction
  double smooth_rate = 0;         ///< rad/s, about the base's z axis, over kSmoothing
  double slow_rate = 0;           ///< rad/s, smooth_rate over kWindUp
  Eigen::Vector2d force{0, 0};    ///< m/s², f along and across, of the last prediction, with as much of gravity as is
                                  ///< significant; without accelerometer 0

  const ContactGeometry& geometry() const noexcept { return geometry_; }
  const FilterNoise& noise() const noexcept { return noise_; }
  double lever(int side) const noexcept;  ///< m, lateral, of the contact from the IMU
  /// m/s: c + χ |c| f_x of that side's contact, where the IMU goes at `u` m/s and turns by `omega` rad/s, base axes.
  double tread_speed(int side, const Eigen::Vector3d& u, const Eigen::Vector3d& omega) const noexcept;
  /// m/s: by how much the contacts drift to the left.
  double creep_across() const noexcept;

 private:
  Innovation correct(const Column& ph, double innovation, double variance, std::span<const int> considered) noexcept;
  /// As `correct`, but base_link stays where it is.
  Innovation learn(const Column& ph, double innovation, double variance, std::span<const int> considered) noexcept;
  Innovation correct_rolling(const Column& ph, double innovation, double variance, double slack,
                             std::span<const int> considered) noexcept;
  /// m/s², specific: of the middle between the contacts, with as much of gravity as is significant.
  Eigen::Vector2d force_on_tyres(const Eigen::Vector3d& accelerometer) const noexcept;
  /// Part of the tilt that is beyond 3 of its deviations, 0 … 1.
  double significant_tilt() const noexcept;
  void transport(const Motion& motion, const Eigen::Matrix3d& middle, const Eigen::Matrix3d& turn,
                 const Eigen::Vector3d& u, const Eigen::Vector3d& omega) noexcept;

  ContactGeometry geometry_;
  FilterNoise noise_;
  FilterPrior prior_;
  Column corrections_;
};

}  // namespace robot_control
