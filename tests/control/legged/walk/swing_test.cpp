#include "control/legged/walk/swing.h"

#include <gtest/gtest.h>

namespace robot_control::tests {

const Eigen::Vector3d kFrom(0.1, -0.05, 0.02), kTo(0.3, 0.07, -0.01);
constexpr double kTop = 0.09, kTime = 0.4;  // m, s

SwingPoint at(double part) {
  return swing_point(kFrom, kTo, kTop, part, kTime);
}

TEST(Swing, GoesFromItsBeginToItsEndAndThroughItsTop) {
  EXPECT_LE((at(0).place - kFrom).norm(), 1e-12);
  EXPECT_LE((at(1).place - kTo).norm(), 1e-12);
  const Eigen::Vector3d middle = (kFrom + kTo) / 2;
  EXPECT_LE((at(0.5).place - Eigen::Vector3d(middle.x(), middle.y(), kTop)).norm(), 1e-12);
}

/// b(¼) = 5/32, and half of the lift after a quarter of the time.
TEST(Swing, HasDoneFiveThirtySecondsOfItsWayAfterAQuarterOfItsTime) {
  const Eigen::Vector3d place = at(0.25).place;
  EXPECT_NEAR(place.x(), kFrom.x() + 5.0 / 32 * (kTo - kFrom).x(), 1e-12);
  EXPECT_NEAR(place.z(), (kFrom.z() + kTop) / 2, 1e-12);
  EXPECT_NEAR(at(0.75).place.z(), (kTo.z() + kTop) / 2, 1e-12);
}

TEST(Swing, ItsVelocityAndAccelerationAreTheDerivatives) {
  constexpr double kStep = 1e-5;  // of the swing
  for (const double part : {0.1, 0.3, 0.45, 0.6, 0.95}) {
    const SwingPoint before = at(part - kStep), point = at(part), after = at(part + kStep);
    const double time = 2 * kStep * kTime;
    EXPECT_LE(((after.place - before.place) / time - point.velocity).norm(), 1e-6) << part;
    EXPECT_LE(((after.velocity - before.velocity) / time - point.acceleration).norm(), 1e-6) << part;
  }
}

TEST(Swing, LeavesAndMeetsTheGroundWithoutSpeedAndWaitsThere) {
  for (const double part : {-0.5, 0.0, 1.0, 1.5}) {
    EXPECT_EQ(at(part).velocity.norm(), 0) << part;
    EXPECT_LE((at(part).place - (part > 0 ? kTo : kFrom)).norm(), 1e-12) << part;
  }
}

}  // namespace robot_control::tests
