#pragma once
/// Do the wheels roll? What encoders and contact say is compared, over short windows, with what the inertial sensors
/// alone say since the window began.
///
/// A window keeps, from its beginning, every correction that the measurements have made since; without them the
/// velocity is the inertial one. Its residuals over its age τ, in metres:
///   left, right   travel measured − travel of the contact, inertial
///   lateral       −(sideways way of the contact, inertial);  vertical likewise
/// Expected deviation, with the velocity's variance at the beginning V, that of the acceleration A (bias and tilt; more
/// where the robot has turned since), the accelerometer's noise n, the path m, and what gyro bias, ratio, wheel base
/// and gyro scale may be wrong by, T:
///   σ² = V τ² + A τ⁴/4 + n² τ³/3;   wheels: + 2 encoder² + slip_noise² |m| + T
/// Beyond kSigmas σ + kCreep |m| + slack the contact is not trusted. Windows of 0.1 s find what happens suddenly,
/// those of 0.3 s and 1 s what happens slowly; two of each length, half of it apart. What the sliding contact has made
/// of velocity, way and acceleration is removed from the oldest window that saw it come, and the velocity is
/// doubted. A contact is trusted again when its speed agrees with the filter's for kAgree judgements in a row, or
/// after kDeadlock seconds; its residuals restart. Where the velocity is known to less than kSure, agreement says
/// less and must last as many times longer, up to kLonger, for a wheel that still slides would take the velocity with
/// it; it is reported as slipping for kReported judgements of agreement at most: then it is on probation, with a
/// confidence of 0. A contact that is distrusted again within kNoSlipTime has contributed nothing: the velocity is
/// known no better than before.
///
/// What the accelerometer's bias and the tilt are together is learned here, from windows of 0.3 s in which everything
/// rolled, kNoSlipTime seconds after the last distrust: a wheel that only begins to slide would otherwise be taken for
/// a bias. A small turn is a short lever between the two: kRoughness is what a window's mean is worth, or a shake would
/// pry them apart. A window close to the limit of a contact is not used for learning, unless kSteady in a row say the
/// same: no slide keeps its acceleration and stays as slow.
///
/// Rolling rubber creeps by up to some percent under force (H. B. Pacejka, Tire and Vehicle Dynamics, 2012, chapter 3):
/// kCreep = 3 % is not called slip.

#include <array>
#include <cstdint>

#include "estimation/filter/error_state_filter.h"

namespace robot_control {

enum class Contact : std::size_t { kLeft, kRight, kLateral, kVertical };
inline constexpr std::size_t kContacts = 4;

class SlipWatch {
 public:
  static constexpr double kCreep = 0.03;
  static constexpr double kLeastAcceleration = 0.02;  ///< m/s², what no inertial sensor on a moving robot knows better
  static constexpr double kSlack = 0.0005;            ///< m
  static constexpr double kJudgeEvery = 0.01;         ///< s
  static constexpr double kAgree = 4;                 ///< judgements, where the velocity is known to kSure
  static constexpr double kSure = 0.007;              ///< m/s; 0.005 … 0.01 do in simulated slides
  static constexpr double kLonger = 10;               ///< times at most
  static constexpr std::uint64_t kReported =
      12;                                      ///< judgements after which a contact is no longer reported as slipping
  static constexpr std::uint64_t kLanded = 2;  ///< the same, of the vertical: what lands stays on the ground
  static constexpr double kAgreeSpeed = 0.02;  ///< m/s, some counts of a usual encoder in the youngest window
  static constexpr double kNoSlipTime = 1.0;   ///< s
  static constexpr double kDeadlock = 10.0;    ///< s; by then a tilt of 1 mrad has made 0.1 m/s: the wheels know better
  static constexpr double kRoughness = 0.05;   ///< m/s², of a window's mean: a body that stops rocks by as much
  static constexpr std::uint64_t kSteady = 5;  ///< windows

  struct Sample {
    double dt = 0;
    double left = 0, right = 0;  ///< m, travel measured over dt; NaN: no reading
    bool inertial = false;       ///< gyro and accelerometer were there
  };

  void reset() noexcept;                                ///< all contacts are trusted
  void begin(const ErrorStateFilter& filter) noexcept;  ///< the same, and windows restart
  void renew(const ErrorStateFilter& filter) noexcept;  ///< windows restart; distrusted contacts stay so

  /// After the filter's prediction and corrections of this cycle. Undoes corrections from the filter where a
  /// contact is found to slip.
  void step(const Sample& sample, ErrorStateFilter& filter) noexcept;

  bool trusts(Contact contact) const noexcept { return states_[static_cast<std::size_t>(contact)].trusted; }
  /// How near to sliding the wheels are, by the last judgement: 0 … 1, the largest residual over its limit.
  double slip_proximity() const noexcept { return slip_proximity_; }
  /// All has rolled for kNoSlipTime seconds: what is learned of the wheels and the gyro may be.
  bool no_recent_slip() const noexcept { return no_slip_time_ >= kNoSlipTime && slip_proximity_ == 0 && !turn_slips_; }
  std::uint64_t reasons() const noexcept { return reasons_; }  ///< SlipReason bits
  /// Residuals of the last judgement over their deviation, squared: of the turn (gyro), of the travel (accelerometer).
  double turn_nis() const noexcept { return turn_nis_; }
  double travel_nis() const noexcept { return travel_nis_; }

 private:
  static constexpr std::size_t kWindows = 6;
  static constexpr std::array<double, kWindows> kLengths{0.1, 0.1, 0.3, 0.3, 1.0, 1.0};
  using Vector4 = std::array<double, kContacts>;

  struct Window {
    double age = 0;
    bool inertial = true;
    ErrorStateFilter::Column corrections = ErrorStateFilter::Column::Zero();
    Eigen::Vector3d acceleration =
        Eigen::Vector3d::Zero();                    ///< m/s², base axes: what corrections of bias and tilt made of it
    Eigen::Vector3d way = Eigen::Vector3d::Zero();  ///< m, base axes: of the corrected velocity beyond the inertial one
    Vector4 measured{};                             ///< m
    Vector4 predicted{};                            ///< m, with the filter's velocity
    Vector4 path{};                                 ///< m, measured or predicted, whichever is longer, sum of sizes
    Eigen::Vector3d velocity_variance = Eigen::Vector3d::Zero();
    Eigen::Vector3d acceleration_variance = Eigen::Vector3d::Zero();
    Eigen::Matrix4d turning_covariance =
        Eigen::Matrix4d::Zero();  ///< of gyro bias about z, ratio, wheel base, gyro scale
    double tilt_variance = 0;     ///< (m/s²)²: of gravity's part, which a turning robot sees from another side
    double turn = 0;              ///< rad
  };
  struct State {
    bool trusted = true;
    std::uint64_t agreed = 0;
    double distrusted_time = 0;  ///< s
    double excess = 0;           ///< m/s, wheel faster than the ground
    double trusted_time = 0;     ///< s, since it was trusted again
    double unsure = 0;           ///< m/s, deviation of the velocity by then; for kNoSlipTime seconds
  };

  void open(Window& window, const ErrorStateFilter& filter) const noexcept;
  void judge(ErrorStateFilter& filter) noexcept;
  bool judge(const Window& window, ErrorStateFilter& filter) noexcept;
  const Window& oldest_that_sees(const std::array<bool, kContacts>& contacts, const Window& sure,
                                 const ErrorStateFilter& filter) const noexcept;
  static double turning_variance(const Window& window, const Eigen::Vector4d& by) noexcept;
  static Eigen::Vector4d by_turning(const Window& window, int side, const ErrorStateFilter& filter) noexcept;
  static double excess(const Window& window, std::size_t contact, const ErrorStateFilter& filter) noexcept;
  void undo(const Window& window, const std::array<bool, 3>& axes, ErrorStateFilter& filter) noexcept;
  void learn_acceleration(const Window& window, ErrorStateFilter& filter) noexcept;
  void re_accept(const Window& window, const ErrorStateFilter& filter) noexcept;
  static double residual(const Window& window, std::size_t contact) noexcept;
  static double variance(const Window& window, std::size_t contact, const ErrorStateFilter& filter) noexcept;
  void report(const ErrorStateFilter& filter) noexcept;

  std::array<Window, kWindows> windows_;
  std::array<State, kContacts> states_;
  double since_judged_ = 0;
  double no_slip_time_ = 0;                              ///< s since a contact was distrusted
  std::uint64_t shaken_ = 0;                             ///< windows in a row that were close to a limit
  Eigen::Vector3d shaken_by_ = Eigen::Vector3d::Zero();  ///< m/s², by which the last one did
  double slip_proximity_ = 0;
  std::uint64_t reasons_ = 0;
  double turn_nis_ = 0;
  double travel_nis_ = 0;
  bool turn_slips_ = false;
};

}  // namespace robot_control
