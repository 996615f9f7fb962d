#include "estimation/legged/foot_contacts.h"

#include <cmath>

#include "machine/gravity.h"
#include "machine/legs/legs_corpus.h"

namespace robot_control::tests {

/// quadbot, which stands level while its legs swing in the air as fast as in a trot.
struct SwingingLegs {
  static constexpr double kPeriod = 0.001;  // s
  LegModel robot = legged_robot("quadbot");
  LegDynamics dynamics{robot};
  FootContacts contacts{robot};
  FootContacts::State state;
  SensorFrame sensors;
  double time = 0;

  /// A force upwards in N acts on foot 0.
  void step(double force) {
    time += kPeriod;
    LeggedMotion motion;
    LeggedAcceleration change;
    for (std::size_t i = 0; i < kLegsJoints; ++i) {
      const double size = i % kLegJoints == 0 ? 0.1 : 0.5, omega = 20;  // rad, rad/s
      motion.angles[i] = (i % kLegJoints == 1 ? 0.8 : i % kLegJoints == 2 ? -1.6 : 0) + size * std::sin(omega * time);
      motion.rates[i] = size * omega * std::cos(omega * time);
      change.joints[i] = -size * omega * omega * std::sin(omega * time);
    }
    const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
    motion.gravity = -kGravity * up;
    sensors.joint_count = kLegsJoints;
    for (std::size_t leg = 0; leg < kLegs; ++leg) {
      Eigen::Vector3d foot;
      const LegKinematics& kinematics = robot.legs[leg].kinematics;
      const Eigen::Matrix3d jacobian = kinematics.jacobian(LegModel::angles_of(motion.angles, leg), foot);
      const Eigen::Vector3d effort =
          dynamics.efforts(leg, motion, change) - jacobian.transpose() * (leg == 0 ? force : 0) * up;
      for (std::size_t i = 0; i < kLegJoints; ++i) {
        JointSample& joint = sensors.joints[kLegJoints * leg + i];
        joint.valid = kValidMotion;
        joint.position = motion.angles[kLegJoints * leg + i];
        joint.velocity = motion.rates[kLegJoints * leg + i];
        joint.effort = effort[static_cast<Eigen::Index>(i)];
      }
    }
    const FeetMotion feet = feet_motion(robot.legs, sensors, Eigen::Vector3d::Zero(), up);
    contacts.step(sensors, feet, Eigen::Vector3d::Zero(), kGravity * up, up, kPeriod, state);
  }
};

TEST(FootContacts, AreNotFoundInLegsThatSwing) {
  SwingingLegs legs;
  for (int k = 0; k < 400; ++k) {
    legs.step(0);
    if (k < 20) continue;
    for (std::size_t leg = 0; leg < kLegs; ++leg) {
      // The swing needs up to 25 N. Masses and angles of the leg change within kObserverTime.
      EXPECT_NEAR(legs.state.loads[leg], 0, 6) << leg;
      EXPECT_EQ(legs.state.probability[leg], 0) << leg;
    }
  }
}

TEST(FootContacts, AreFoundWithinMillisecondsAndSoonerWhereTheyAreAskedFor) {
  for (const bool asked : {false, true}) {
    SwingingLegs legs;
    for (int k = 0; k < 100; ++k) legs.step(0);
    if (asked) legs.sensors.gate.contact_schedule[0] = 0.01;
    int found = 0;
    while (!FootContacts::bears(legs.state.probability[0]) && found < 100) legs.step(20), ++found;
    EXPECT_LE(found, asked ? 5 : 12);
    EXPECT_GE(found, asked ? 2 : 5);
    for (int k = 0; k < 20; ++k) legs.step(20);
    EXPECT_NEAR(legs.state.loads[0], 20, 6);
    EXPECT_EQ(legs.state.probability[1], 0);
  }
}

TEST(FootContacts, AreWeighedByForceSensorsWhereAllFeetHaveThem) {
  SwingingLegs legs;
  legs.sensors.contact_count = kLegs;
  for (std::size_t leg = 0; leg < kLegs; ++leg) legs.sensors.contacts[leg] = {.force = {3, 0, 25}, .valid = 1};
  legs.step(0);
  EXPECT_EQ(legs.state.loads[0], 25);
  EXPECT_EQ(legs.state.probability[0], 1);
  legs.sensors.contacts[2].valid = 0;
  for (int k = 0; k < 20; ++k) legs.step(0);
  EXPECT_EQ(legs.state.probability[0], 0);
}

}  // namespace robot_control::tests
