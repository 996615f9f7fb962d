#include "estimation/wheeled/estimator.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "estimation/common/values.h"
#include "estimation/wheeled/estimator_setup.h"
#include "estimation/wheeled/wheels/arc.h"
#include "machine/gravity.h"
#include "signals/rotation.h"

namespace robot_control {
Estimator::State::State(const EstimatorParameters& parameters, const DriveTrain& robot, double period)
    : wheel_sides(robot, parameters.speed_bandwidth, period, std::sqrt(12.0) * encoder_deviation(parameters, robot)),
      core(core_params(parameters, robot)),
      tilt(tilt_params(parameters)),
      gyro_noise(parameters.gyro_noise),
      slip(slip_params(parameters, robot)),
      rest(rest_params(parameters, robot)),
      rate(parameters.rate_bandwidth, period) {}

Estimator::Estimator(const EstimatorParameters& parameters, const DriveTrain& robot, double period)
    : parameters_(checked(parameters, robot, period)),
      period_(period),
      geometry_(robot),
      wheel_slip_(robot),
      base_from_imu_(rotation_of(robot.imu_in_base.orientation)),
      encoder_(encoder_deviation(parameters, robot)),
      state_(parameters, robot, period),
      fresh_(state_) {
  const Eigen::Vector3d bias = base_from_imu_ * vector(parameters.gyro_bias);
  for (const int i : {0, 1}) state_.gyro_bias[i] = {bias[i], square(parameters.gyro_bias_initial)};
  state_.core.set_bias(bias.z(), parameters.gyro_bias_initial);
  state_.core.set_calibration(parameters.calibration);
  place({0, 0, 0});
  fresh_ = state_;
}

void Estimator::place(const Vector3& pose) noexcept {
  const Planar lever = axle(pose[2]);
  const Prediction ahead = prediction();
  state_.core.place({pose[0] + lever.x - ahead.distance * std::cos(pose[2]),
                     pose[1] + lever.y - ahead.distance * std::sin(pose[2]), pose[2] - ahead.turn});
  state_.comparison.interrupt();
}

void Estimator::step(const SensorFrame& sensors, StateFrame& out) noexcept {
  State& s = state_;
  const std::uint64_t cycle = sensors.head.cycle;
  if (s.began && cycle <= s.cycle && !s.restart_pending) return fill(sensors, out);
  const std::uint64_t cycles = s.began && cycle > s.cycle ? cycle - s.cycle : 0;
  s.flags = cycles > 1 ? std::uint64_t{kStateSkipped} : 0;
  if (!s.began) s.skipped = cycle;  // The run began before the first frame.
  if (cycles > 1) s.skipped += cycles - 1;
  s.began = true;
  s.cycle = cycle;
  advance(sensors, static_cast<double>(cycles) * period_);
  fill(sensors, out);
}

void Estimator::step(const SensorFrame& sensors, double dt, StateFrame& out) noexcept {
  state_.flags = 0;
  advance(sensors, std::exchange(state_.began, true) ? dt : 0);
  fill(sensors, out);
}

void Estimator::advance(const SensorFrame& sensors, double dt) noexcept {
  State& s = state_;
  s.core.show(dt);
  read(sensors, dt);
  if (std::exchange(s.restart_pending, false)) {
    s.core.shift(0, 0, square(Tuning::kRestart) + square(s.wheels.mean_speed() * dt));
    s.core.add_yaw_variance(square(Tuning::kRestart) + square(wheel_rate() * dt));
  } else if (dt > 0) {
    integrate_wheels();
    if (!s.rest.resting()) move(dt);
    watch_rest(dt);
  }
  const bool by_gyro = s.imu.gyro && !s.rest.resting();
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();
  if (!s.rest.resting()) rate.z() = s.yaw_rate;
  if (by_gyro) rate = vector(s.imu.rate) - gyro_bias();
  s.rate.follow(rate, by_gyro, dt);
  s.pose_set = std::exchange(s.pose_request, std::nullopt);
  if (!s.pose_set) return;
  place(*s.pose_set);
  s.rest.forget_held();
}

void Estimator::read(const SensorFrame& sensors, double dt) noexcept {
  State& s = state_;
  s.imu = s.imu_samples.step(sensors, base_from_imu_, dt);
  s.wheels = s.wheel_sides.step(sensors, dt, s.imu.gyro.has_value());
  if (s.imu.fresh_gyro) s.gyro_noise.add(s.imu.sample[2], s.imu.gyro_gap, s.rest.standing());
  if (s.imu.refused || s.wheels.refused) s.flags |= kStateBadSample;
  if (!s.imu.gyro) s.flags |= kStateNoGyro;
  if (!s.imu.accelerometer) s.flags |= kStateNoAccelerometer;
  if (!s.wheels.received[kLeft]) s.flags |= kStateNoLeftEncoder;
  if (!s.wheels.received[kRight]) s.flags |= kStateNoRightEncoder;
  if (s.wheels.restarted) s.comparison.interrupt();
  for (const std::size_t side : {kLeft, kRight}) {
    const double time = s.wheels.unknown_time[side];
    if (time == 0) continue;
    s.flags |= kStateEncoderRestarted;
    const bool replaced = !s.wheels.lost[1 - side] && s.wheels.unknown_time[1 - side] == 0;
    s.comparison.suspend();
    s.middle_travel.forget_credit(side);
    s.core.shift(0, 0, square(Tuning::kRestart));
    s.slip.restart();
    if (time <= Tuning::kMaxHoldTime) continue;
    s.middle_travel.forget_turn();
    if (!replaced) lose_travel(time);
  }
}

/// The position stays where the last speed has predicted it, and the speed is taken to be zero.
void Estimator::lose_travel(double time) noexcept {
  State& s = state_;
  const Planar predicted = rotated({prediction().distance - s.wheels.unread, 0}, s.core.pose().yaw);
  s.core.shift(predicted.x, predicted.y, square(s.wheels.mean_speed() * time));
  s.wheel_sides.set_speed(0, 0);
  s.wheels.speed = {};
}

/// Raw odometry integrates the travel of either side since its last reading.
void Estimator::integrate_wheels() noexcept {
  WheelOdometry& odometry = state_.wheel_odometry;
  const WheelReading& wheels = state_.wheels;
  const Motion motion = geometry_.base_motion(wheels.mean(), geometry_.turn(wheels.left(), wheels.right()));
  const Planar chord = chord_of(motion, odometry.yaw);
  odometry.x += chord.x;
  odometry.y += chord.y;
  odometry.yaw += motion.turn;
  if (std::abs(odometry.yaw) > std::numbers::pi) odometry.yaw = std::remainder(odometry.yaw, 2 * std::numbers::pi);
  const Motion velocity = geometry_.base_motion(wheels.mean_speed(), wheel_rate());
  odometry.linear = velocity.forward;
  odometry.angular = velocity.turn;
}

/// The gyro turns, the wheels move, slip is watched and the calibration is learned.
void Estimator::move(double dt) noexcept {
  State& s = state_;
  const double before = s.core.pose().yaw;
  const double already = s.middle_travel.turned_since(s.wheels);
  const double wheel_turn = s.core.wheel_turn(s.wheels.left(), s.wheels.right()) - already;
  const std::optional<double> angle = s.gyro_turn.step(s.imu, wheel_turn, s.core.bias(), dt);
  const bool by_gyro = angle.has_value();
  if (by_gyro) {
    s.core.turn_by_gyro(*angle, dt);
  } else {
    s.core.turn_by_wheels(s.wheels.left(), s.wheels.right(), already);
    s.comparison.interrupt();
  }
  s.yaw_rate = by_gyro ? s.imu.rate[2] - s.core.bias() : wheel_rate();
  const double turned = s.core.pose().yaw - before;
  double travelled = 0;
  for (const auto& travel : s.middle_travel.step(s.wheels, turned, geometry_.wheel_base, s.core.ratio())) {
    roll(travel);
    travelled += travel.distance;
  }
  s.core.shift(0, 0, s.wheels.travel_variance / 2);
  if (s.imu.gyro) turn_tilt(*s.imu.gyro, dt);
  if (parameters_.slip_detection) watch_slip(dt, travelled);
  compare_turns(dt, by_gyro);
}

/// `gyro` is in rad/s and includes the bias.
void Estimator::turn_tilt(const Vector3& gyro, double dt) noexcept {
  Eigen::Vector3d rate = vector(gyro) - gyro_bias();
  if (!state_.rest.bias_measured()) rate.head<2>().setZero();
  state_.tilt.turn(array(rate), dt);
}

/// Slope and creep shorten the distance, which is laid along the heading that the robot had halfway.
void Estimator::roll(const MiddleTravel::Travel& travel) noexcept {
  State& s = state_;
  const double sine = s.tilt.up()[0];
  const double level = travel.distance * std::sqrt(std::max(0.0, 1 - sine * sine));
  const Planar creep = tyres_creep(travel.distance);
  const double late_rate = s.yaw_rate * travel.late;
  const double turned = travel.turn_since + late_rate * s.core.offset();
  const Planar path = rotated({level - creep.x, -creep.y}, -turned);
  const Planar odom = rotated(path, s.core.pose().yaw);
  s.core.roll(odom.x, odom.y, late_rate);
  s.height += travel.distance * sine;
  s.distance += std::abs(travel.distance);
}

/// Returns by how much less the robot travels than its treads roll, along and to the left, in m. A tyre under force
/// creeps by tyre_creep times the specific force per distance (H. B. Pacejka, Tire and Vehicle Dynamics, 2012, chapter
/// 3, linear range). Gravity counts only beyond kSignificant deviations of the tilt.
Planar Estimator::tyres_creep(double distance) const noexcept {
  const Tilt& tilt = state_.tilt;
  if (!state_.imu.accelerometer || parameters_.tyre_creep == 0) return {};
  std::array<double, 2> creep = tilt.acceleration(*state_.imu.accelerometer);
  for (const int axis : {0, 1}) {
    const double sine = tilt.up()[axis];
    const double uncertain = Tuning::kSignificant * std::sqrt(std::max(0.0, tilt.covariance(axis, axis)));
    creep[axis] += kGravity * std::copysign(std::max(0.0, std::abs(sine) - uncertain), sine);
    creep[axis] = std::clamp(creep[axis], -kGravity, kGravity);  // No tyre holds more.
  }
  return Planar{creep[0], creep[1]} * (parameters_.tyre_creep * std::abs(distance));
}

void Estimator::smooth_nis(SensorIndex sensor, double nis, double dt) noexcept {
  if (!(nis >= 0)) return;  // A sensor of this comparison is lost.
  double& smoothed = state_.nis[sensor];
  smoothed += dt / (Tuning::kBlock + dt) * (std::min(nis, Tuning::kMaxNis) - smoothed);
}

/// Predicts the motion since the readings that the core has used. A positive clock offset means that the wheels are
/// late, a negative one that the gyro is late. A side without a reading in this step is predicted by its speed.
Estimator::Prediction Estimator::prediction() const noexcept {
  const State& s = state_;
  if (s.rest.resting()) return {};
  const double offset = s.core.offset();
  const double lost = (s.wheels.lost_speed[kLeft] + s.wheels.lost_speed[kRight]) / 2;
  return {.distance = s.wheels.unread + (offset > 0 ? (forward_speed() + lost) * offset : 0),
          .turn = offset > 0 ? 0 : -s.yaw_rate * offset};
}

/// If one side is lost, the speed of the middle follows from the other side and the yaw rate.
double Estimator::forward_speed() const noexcept {
  const State& s = state_;
  if (s.rest.resting()) return 0;
  double speed = s.wheels.mean_speed();
  const double faster = s.rate.rate().z() * geometry_.wheel_base / 2;
  if (s.wheels.any_lost() && !s.wheels.both_lost()) {
    speed = s.wheels.lost[kLeft] ? s.wheels.speed[kRight] - faster : s.wheels.speed[kLeft] + faster;
  }
  return speed;
}

double Estimator::wheel_rate() const noexcept {
  return geometry_.turn(state_.wheels.speed[kLeft], state_.wheels.speed[kRight]);
}

Eigen::Vector3d Estimator::gyro_bias() const noexcept {
  return {state_.gyro_bias[0].value, state_.gyro_bias[1].value, state_.core.bias()};
}

Eigen::Vector3d Estimator::gyro_bias_variance() const noexcept {
  return {state_.gyro_bias[0].variance, state_.gyro_bias[1].variance, state_.core.bias_variance()};
}

/// Returns the vector from base_link to the middle of the wheels, in m, odom axes.
Planar Estimator::axle(const Turn& yaw) const noexcept {
  return rotated({geometry_.axle[0], geometry_.axle[1]}, yaw);
}

}  // namespace robot_control
