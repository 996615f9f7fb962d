#include "estimation/pose_covariance.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

namespace robot_control {
namespace {

Eigen::Matrix4d matrix_of(const PoseCovariance& covariance) {
  Eigen::Matrix4d matrix;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) matrix(row, column) = covariance.at(row, column);
  }
  return matrix;
}

/// One step straight ahead along x, wheels alone.
CovarianceStep straight(double distance) {
  CovarianceStep step;
  step.chord = chord_of({distance, 0, 0}, 0);
  step.per_turn = {0, 0, 1};
  step.dt = 1e-3;
  step.distance_variance = 4e-4 * distance;
  step.wheel_turn_variance = 1e-3 * distance;
  return step;
}

// Along the way n steps of variance v add to n·v; yaw errors of variance w per step, made at step i, move the end
// sideways by (n − i + ½) steps: w s² Σ(j + ½)² for j = 0 … n−1.
TEST(PoseCovariance, GrowsAsTheSumOfItsSteps) {
  PoseCovariance covariance(0);
  const int steps = 1000;
  const double length = 1e-3;
  double squares = 0;
  for (int i = 0; i < steps; ++i) {
    covariance.step(straight(length));
    squares += (i + 0.5) * (i + 0.5);
  }
  EXPECT_NEAR(covariance.at(0, 0), 4e-4 * steps * length, 1e-12);
  EXPECT_NEAR(covariance.at(2, 2), 1e-3 * steps * length, 1e-12);
  EXPECT_NEAR(covariance.at(1, 1), 1e-3 * length * length * length * squares, 1e-10);
  EXPECT_GT(covariance.at(1, 2), 0);
}

TEST(PoseCovariance, StaysSymmetricAndPositive) {
  PoseCovariance covariance(2.5e-3);
  double yaw = 0;
  for (int i = 0; i < 20000; ++i) {
    CovarianceStep step = straight(5e-4);
    const double turn = 1e-3 * std::sin(i * 1e-3);
    step.chord = chord_of({5e-4, 0, turn}, yaw);
    step.gain = 0.9;
    step.gyro_turn_variance = 1e-9;
    covariance.step(step);
    yaw += turn;
    if (i % 5000 == 4999) covariance.learn_bias(1e-6);
  }
  const Eigen::Matrix4d matrix = matrix_of(covariance);
  EXPECT_EQ(matrix, matrix.transpose());
  const Eigen::Vector4d values = Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(matrix).eigenvalues();
  EXPECT_GT(values.minCoeff(), 0);
}

// A constant bias error σ turns by K σ t: variance K² σ² t².
TEST(PoseCovariance, BiasErrorGrowsYawWithTimeNotWithItsRoot) {
  const double bias_variance = 1e-6;
  PoseCovariance covariance(bias_variance);
  CovarianceStep step = straight(0);
  step.gain = 0.5;
  for (int i = 0; i < 10000; ++i) covariance.step(step);
  EXPECT_NEAR(covariance.at(2, 2), 0.25 * bias_variance * 100, 1e-12);
}

TEST(PoseCovariance, LearningTheBiasIsTheScalarFilter) {
  PoseCovariance covariance(4e-6);
  EXPECT_DOUBLE_EQ(covariance.learn_bias(1e-6), 0.8);
  EXPECT_NEAR(covariance.bias_variance(), 0.8e-6, 1e-20);
}

TEST(PoseCovariance, RestoresWhatWasPublished) {
  Matrix6 published{};
  published[0] = 1;
  published[7] = 2;
  published[35] = 3;
  published[5] = published[30] = 0.5;
  PoseCovariance covariance(1e-4);
  covariance.restore(published);
  EXPECT_EQ(covariance.at(0, 0), 1);
  EXPECT_EQ(covariance.at(1, 1), 2);
  EXPECT_EQ(covariance.at(2, 2), 3);
  EXPECT_EQ(covariance.at(0, 2), 0.5);
  EXPECT_EQ(covariance.at(2, 0), 0.5);
  EXPECT_EQ(covariance.bias_variance(), 1e-4);
}

}  // namespace
}  // namespace robot_control
