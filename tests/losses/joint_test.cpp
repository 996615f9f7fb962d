/// One joint of a robot on four wheels gives no sample, an old one, or a fault, at full speed.

#include "losses_fixture.h"
#include "support/temporary_folder.h"

namespace robot_control::tests {

/// 17 kg on four wheels of 0.1 m.
std::string four_wheels() {
  std::string urdf = R"(<robot name="four_wheels"><link name="base_link">
    <inertial><mass value="15"/><inertia ixx="0.3" ixy="0" ixz="0" iyy="0.4" iyz="0" izz="0.45"/></inertial>
    <collision><geometry><box size="0.4 0.3 0.1"/></geometry></collision></link>)";
  for (const auto& [name, x, y] : {std::tuple{"front_left", "0.13", "0.19"},
                                   {"rear_left", "-0.13", "0.19"},
                                   {"front_right", "0.13", "-0.19"},
                                   {"rear_right", "-0.13", "-0.19"}}) {
    urdf += std::string("<link name=\"") + name + R"("><inertial><mass value="0.5"/>
      <inertia ixx="0.0014" ixy="0" ixz="0" iyy="0.0024" iyz="0" izz="0.0014"/></inertial>
      <collision><origin rpy="1.5707963 0 0"/><geometry><cylinder radius="0.1" length="0.04"/></geometry></collision>
      </link><joint name=")" +
            name + R"(_wheel" type="continuous"><parent link="base_link"/><child link=")" + name +
            R"("/><origin xyz=")" + x + " " + y +
            R"( 0"/><axis xyz="0 1 0"/><limit effort="4.5" velocity="20"/></joint>)";
  }
  return urdf + "</robot>";
}

const TemporaryFolder& folder() {
  static const TemporaryFolder folder;
  return folder;
}

Parameters with_four_wheels() {
  Parameters parameters = DrivingRobot::quick(kParams);
  parameters.urdf = folder().write("four_wheels.urdf", four_wheels()).string();
  parameters.robot = {};
  return parameters;
}

struct FailingJoint {
  const char* name;
  Spoiled how;
  std::uint64_t cause;
  std::uint64_t cycles;  ///< from the sample to the brake, beyond those of the monitor and the gate
};

struct AJoint : Losses, ::testing::WithParamInterface<FailingJoint> {
  AJoint() : Losses(with_four_wheels()) {}
};

TEST_P(AJoint, StopsTheRobotAndIsNamedIfItFails) {
  const FailingJoint& failing = GetParam();
  ASSERT_EQ(nodes().robot().joints.size(), 4u);
  SpoilRequest& request = nodes().controls().spoil;
  const std::uint64_t before = robot_.cycle();
  request.joint.store(2);
  request.how.store(failing.how);
  ASSERT_TRUE(robot_.await([&] { return (robot_.permit().causes & failing.cause) != 0; })) << robot_.situation();
  request.how.store(Spoiled::kNot);
  const Permit permit = robot_.permit();
  ASSERT_EQ(permit.first_cause, failing.cause) << names_of(kStopCauseNames, permit.causes);
  EXPECT_EQ(permit.evidence[0].joint, 2u);
  if (!robot_.stalled()) {
    EXPECT_LE(permit.evidence[0].cycle, before + failing.cycles + kBrakeWithin);
  }
}

INSTANTIATE_TEST_SUITE_P(OfFour, AJoint,
                         ::testing::Values(FailingJoint{"Missing", Spoiled::kMissing, kCauseEncodersLost, 10},
                                           FailingJoint{"Stale", Spoiled::kStale, kCauseEncodersLost, 10},
                                           FailingJoint{"Faulty", Spoiled::kFaulty, kCauseDriverFault, 1}),
                         [](const auto& each) { return std::string(each.param.name); });

}  // namespace robot_control::tests
