#include "navigation/guard/moving_outline.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace robot_control::navigation::tests {

/// A body of 0.4 m × 0.2 m that carries a thin leg of 0.3 m, which hangs from its front edge.
constexpr const char* kOneLeg = R"(<robot name="one_leg">
  <link name="base_link">
    <inertial><mass value="9"/><inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial>
    <collision><geometry><box size="0.4 0.2 0.1"/></geometry></collision>
  </link>
  <link name="leg">
    <inertial><mass value="1"/><inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial>
    <collision><origin xyz="0 0 -0.15"/><geometry><box size="0.02 0.02 0.3"/></geometry></collision>
  </link>
  <joint name="thigh" type="revolute">
    <parent link="base_link"/><child link="leg"/><origin xyz="0.2 0 0"/><axis xyz="0 1 0"/>
    <limit lower="-2" upper="2" effort="10" velocity="10"/>
  </joint>
</robot>)";

struct MovingOutlineTest : testing::Test {
  /// m that the robot reaches ahead.
  double reach() const {
    double x = 0;
    for (const Point corner : outline.footprint().corners) x = std::max(x, corner.x);
    return x;
  }
  const RigidBodies robot = read_rigid_bodies({kOneLeg, "the test"});
  MovingOutline outline{robot, footprint_of(robot)};
};

TEST_F(MovingOutlineTest, ALegThatSwingsForwardExtendsItForAStride) {
  EXPECT_TRUE(outline.changes());
  EXPECT_NEAR(reach(), 0.21, 1e-3);
  outline.update({{"thigh", -M_PI / 2}}, 10);
  EXPECT_NEAR(reach(), 0.5, 1e-2);
  for (double now = 10.1; now < 10.95; now += 0.1) outline.update({{"thigh", 0}}, now);
  EXPECT_NEAR(reach(), 0.5, 1e-2);
  for (double now = 11.05; now < 11.2; now += 0.1) outline.update({{"thigh", 0}}, now);
  EXPECT_NEAR(reach(), 0.21, 1e-3);
}

TEST_F(MovingOutlineTest, UnknownJointsChangeNothing) {
  outline.update({{"wing", 1}}, 10);
  EXPECT_NEAR(reach(), 0.21, 1e-3);
}

}  // namespace robot_control::navigation::tests
