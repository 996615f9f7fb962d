// Proof of slip without a filter's state.

#include "estimation/simple/slip_evidence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "signals/state_frame.h"

namespace robot_control {
namespace {

constexpr double kSampleTime = 0.01;  // s

class SlipEvidenceTest : public testing::TestWithParam<unsigned> {
 protected:
  struct Floor {
    double white = 0;   ///< m/s²/√Hz
    double slow = 0;    ///< m/s²
    double jitter = 0;  ///< s
  };

  /// Accelerates back and forth by ±0.5 m/s²; the treads are faster than the ground by `spin` m/s² · t.
  int drive(double seconds, const Floor& floor, double spin = 0) {
    int proofs = 0;
    double excess = 0;
    for (double t = 0; t < seconds; t += kSampleTime) {
      const double acceleration = std::fmod(time_, 2.0) < 1.0 ? 0.5 : -0.5;
      speed_ += acceleration * kSampleTime;
      excess += spin * kSampleTime;
      time_ += kSampleTime;
      late_ += (floor.jitter * normal_(random_) - late_);
      const double seen = speed_ * (kSampleTime + late_ - last_late_) + excess * kSampleTime;
      last_late_ = late_;
      slow_ += kSampleTime / 3 * (-slow_) + floor.slow * std::sqrt(2 * kSampleTime / 3) * normal_(random_);
      SlipEvidence::Sample sample;
      sample.dt = kSampleTime;
      sample.force = {acceleration + slow_ + floor.white / std::sqrt(kSampleTime) * normal_(random_), 0, 9.80665};
      sample.left = sample.right = seen;
      sample.read = sample.inertial = true;
      sample.speed = speed_;
      evidence_.step(sample);
      proofs += evidence_.proven() ? 1 : 0;
    }
    return proofs;
  }

  SlipEvidence evidence_{SlipEvidenceParams{}};
  std::mt19937 random_{GetParam()};
  std::normal_distribution<double> normal_{0, 1};
  double speed_ = 0.7;  // m/s; it need not be known
  double time_ = 0;
  double late_ = 0, last_late_ = 0, slow_ = 0;
};

TEST_P(SlipEvidenceTest, ExactSensorsProveNothingWhateverTheSpeedAtTheBeginning) {
  EXPECT_EQ(drive(60, {}), 0);
}

// Vibration, slow errors and jitter of a skid steer on a floor; 5 % is what a drive may be called slip.
TEST_P(SlipEvidenceTest, AShakingFloorProvesNextToNothing) {
  EXPECT_LT(drive(120, {.white = 0.065, .slow = 0.1, .jitter = 0.002}), 0.02 * 120 / kSampleTime);
  EXPECT_GT(evidence_.level(), 2);
}

TEST_P(SlipEvidenceTest, ASpinIsProvenWithinHalfASecond) {
  drive(20, {.white = 2e-3, .slow = 0.005});
  ASSERT_FALSE(evidence_.proven());
  EXPECT_GT(drive(0.6, {.white = 2e-3, .slow = 0.005}, 2.0), 0);
  EXPECT_TRUE((evidence_.reasons() & kSlipLeft) != 0 && (evidence_.reasons() & kSlipRight) != 0);
}

TEST_P(SlipEvidenceTest, BeforeAnythingIsKnownOnlyAViolentSpinIsProven) {
  EXPECT_EQ(drive(1.0, {}, 0.5), 0);
  evidence_.reset();
  EXPECT_GT(drive(1.0, {}, 4.0), 0);
}

TEST_P(SlipEvidenceTest, OneLateStampIsNoSlip) {
  drive(20, {.white = 2e-3, .slow = 0.005});
  SlipEvidence::Sample sample;
  sample.dt = kSampleTime;
  sample.force = {0, 0, 9.80665};
  sample.read = sample.inertial = true;
  sample.speed = speed_;
  for (int i = 0; i < 200; ++i) {
    const double late = i == 100 ? -0.006 : i == 101 ? 0.006 : 0.0;  // s
    sample.left = sample.right = speed_ * (kSampleTime + late);
    evidence_.step(sample);
    EXPECT_FALSE(evidence_.proven()) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, SlipEvidenceTest, testing::Range(0U, 5U));

}  // namespace
}  // namespace robot_control
