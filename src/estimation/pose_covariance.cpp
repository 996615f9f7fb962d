#include "estimation/pose_covariance.h"

namespace robot_control {

void PoseCovariance::reset() noexcept {
  covariance_.setZero();
  covariance_(3, 3) = initial_bias_variance_;
}

void PoseCovariance::reset_pose() noexcept {
  const double bias = covariance_(3, 3);
  covariance_.setZero();
  covariance_(3, 3) = bias;
}

void PoseCovariance::restore(const Matrix6& pose_covariance) noexcept {
  constexpr int kIndex[3] = {0, 1, 5};
  reset();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      const int upper = kIndex[row < column ? row : column];
      const int lower = kIndex[row < column ? column : row];
      covariance_(row, column) = pose_covariance[static_cast<std::size_t>(6 * upper + lower)];
    }
  }
}

void PoseCovariance::step(const CovarianceStep& step) noexcept {
  const Chord& chord = step.chord;
  const Eigen::Vector4d by_distance{chord.x_by_forward, chord.y_by_forward, 0, 0};
  const Eigen::Vector4d by_turn{
      chord.x_by_turn + chord.x_by_forward * step.per_turn.forward + chord.x_by_left * step.per_turn.left,
      chord.y_by_turn + chord.y_by_forward * step.per_turn.forward + chord.y_by_left * step.per_turn.left, 1, 0};
  Eigen::Matrix4d transition = Eigen::Matrix4d::Identity();
  transition(0, 2) = -chord.y;
  transition(1, 2) = chord.x;
  transition.col(3) -= step.gain * step.dt * by_turn;

  const double trust = 1 - step.gain;
  const double turn_variance =
      trust * trust * step.wheel_turn_variance + step.gain * step.gain * step.gyro_turn_variance;
  const Eigen::Matrix4d moved = transition * covariance_ * transition.transpose();
  const Eigen::Matrix4d grown = moved + step.distance_variance * by_distance * by_distance.transpose() +
                                turn_variance * by_turn * by_turn.transpose();
  covariance_ = (grown + grown.transpose()) / 2;
}

void PoseCovariance::grow_pose(double position_variance, double yaw_variance) noexcept {
  covariance_(0, 0) += position_variance;
  covariance_(1, 1) += position_variance;
  covariance_(2, 2) += yaw_variance;
}

double PoseCovariance::learn_bias(double variance) noexcept {
  const double bias = covariance_(3, 3);
  const double gain = bias > 0 ? bias / (bias + variance) : 0;
  covariance_.row(3) *= 1 - gain;
  covariance_.col(3) *= 1 - gain;  // the corner twice: (1 - k)²
  covariance_(3, 3) += gain * gain * variance;
  return gain;
}

}  // namespace robot_control
