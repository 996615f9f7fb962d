/// The behaviour of the simulated machine, observed through the driver's four calls.

#include "drivers/mujoco/constants.h"
#include "drivers/mujoco/plant_fixture.h"

namespace robot_control::tests {

constexpr double kRadius = 0.1;
constexpr double kBase = 0.5;
const double kSlopeAngle = 5 * M_PI / 180;

using MujocoPlantTest = PlantTest;

TEST_F(MujocoPlantTest, StandsOnItsWheelsAfterStart) {
  auto plant = started();
  const SensorFrame frame = sensors(*plant);
  EXPECT_EQ(frame.driver_state, DriverState::kRunning);
  EXPECT_EQ(frame.faults, 0u);
  EXPECT_EQ(frame.valid, kValidGyro | kValidAccelerometer);
  EXPECT_TRUE(joints_have(frame, 2, kValidMotion));
  EXPECT_EQ(frame.joint_count, 2u);
  EXPECT_EQ(plant->data()->ncon, 3) << "two wheels and the caster";
  EXPECT_EQ(plant->data()->time, 0);
}

TEST_F(MujocoPlantTest, TruthBeginsAtZero) {
  for (const char* scene : {kFlat, kSlope}) {
    const TruthFrame frame = truth(*started(scene));
    EXPECT_EQ(frame.pose_world.position, (Vector3{0, 0, 0}));
    EXPECT_NEAR(frame.pose_world.orientation[3], 1, 2e-10);  // φ²/8; contacts give way by less than 10 µm over 0.25 m
  }
}

// The law of the lever about the caster: the axle carries (0.25 − l)/0.25 of the weight. The centre of gravity is l
// behind the axle. The hard contact's residual accelerations at rest are far below 0.1 %.
TEST_F(MujocoPlantTest, WheelsCarryTheirShareOfTheWeight) {
  const DriveTrain robot = read_drive_train(diffbot_urdf(), {});
  const double share = (0.25 + robot.centre_of_gravity_base[0]) / 0.25;
  const TruthFrame frame = truth(*started());
  EXPECT_NEAR(frame.normal_force[0] + frame.normal_force[1], share * 12 * kEarthGravity, 0.001 * 12 * kEarthGravity);
}

// The whole frame is as at rest: 1e-4 m/s² is 1e-5 of g.
TEST_F(MujocoPlantTest, AccelerometerShowsGravityUpwardsAtRest) {
  const ImuSample flat = sensors(*started()).imu;
  EXPECT_NEAR(flat.linear_acceleration[0], 0, 1e-4);
  EXPECT_NEAR(flat.linear_acceleration[1], 0, 1e-4);
  EXPECT_NEAR(flat.linear_acceleration[2], kEarthGravity, 1e-4);
}

TEST_F(MujocoPlantTest, AccelerometerShowsTheSlope) {
  const ImuSample slope = sensors(*started(kSlope)).imu;
  EXPECT_NEAR(slope.linear_acceleration[0], kEarthGravity * std::sin(kSlopeAngle), 1e-3) << "facing uphill";
  EXPECT_NEAR(slope.linear_acceleration[2], kEarthGravity * std::cos(kSlopeAngle), 1e-3);
}

TEST_F(MujocoPlantTest, BrakeTorqueHoldsTheWeightDownTheSlope) {
  const SensorFrame frame = sensors(*started(kSlope));
  EXPECT_NEAR(frame.joints[0].effort + frame.joints[1].effort, 12 * kEarthGravity * std::sin(kSlopeAngle) * kRadius,
              1e-3);
}

class BrakeHolds : public PlantTest, public testing::WithParamInterface<std::tuple<const char*, double>> {};

TEST_P(BrakeHolds, AMinuteWithoutMoving) {
  auto plant = started(std::get<0>(GetParam()), std::get<1>(GetParam()));
  hold(*plant, brakes_, 60);
  EXPECT_LT(distance(truth(*plant).pose_world.position, {}), 0.2e-3);
}

INSTANTIATE_TEST_SUITE_P(MujocoPlantTest, BrakeHolds,
                         testing::Combine(testing::Values(kFlat, kSlope), testing::Values(0.01, 0.001)));

class RollsTrue : public PlantTest, public testing::WithParamInterface<double> {};

TEST_P(RollsTrue, DistanceIsRadiusTimesAngle) {
  auto plant = started(kFlat, GetParam());
  for (const double speed : {5.0, -5.0}) {
    speed_up(*plant, speed, speed);
    const double angle = sensors(*plant).joints[0].position;
    const Vector3 position = truth(*plant).pose_world.position;
    hold(*plant, both(velocity_command(speed), velocity_command(speed)), 2);
    const double turned = sensors(*plant).joints[0].position - angle;
    EXPECT_NEAR(truth(*plant).pose_world.position[0] - position[0], kRadius * turned,
                0.0001 * kRadius * std::abs(turned));
  }
}

TEST_P(RollsTrue, YawRateIsWheelDifferenceOverWheelBase) {
  auto plant = started(kFlat, GetParam());
  speed_up(*plant, 4, 6);
  const SensorFrame frame = sensors(*plant);
  const double expected = kRadius * (frame.joints[1].velocity - frame.joints[0].velocity) / kBase;
  EXPECT_NEAR(truth(*plant).twist_base.angular[2], expected, 0.0005 * expected);
}

TEST_P(RollsTrue, WheelsRollStraightWithoutSlip) {
  auto plant = started(kFlat, GetParam());
  speed_up(*plant, 5, 5);
  EXPECT_LT(truth(*plant).slip[0], 1e-5);
  EXPECT_LT(truth(*plant).slip[1], 1e-5);
}

// See the header: v ω T/2 with T = 0.99 · 4 ms, 0.4 mm/s here.
TEST_P(RollsTrue, NativeWheelsSlipSidewaysInACurveByTheContactsTimeConstant) {
  tyre_ = TyreModel::kNative;
  auto plant = started(kFlat, GetParam());
  speed_up(*plant, 4, 6);
  const TruthFrame frame = truth(*plant);
  const double expected = frame.twist_base.linear[0] * frame.twist_base.angular[2] * 0.99 * 0.004 / 2;
  EXPECT_NEAR(frame.slip[0], expected, 0.05 * expected);
  EXPECT_NEAR(frame.twist_base.linear[1], -expected, 0.05 * expected);
}

// tyre.h: the centripetal force of each wheel's share, F = m/2 · v ω, makes it creep by F v / (k L).
TEST_P(RollsTrue, ATyreCreepsSidewaysInACurveByLessThanANativeWheel) {
  auto plant = started(kFlat, GetParam());
  speed_up(*plant, 4, 6);
  const TruthFrame frame = truth(*plant);
  EXPECT_LT(std::abs(frame.twist_base.linear[1]), frame.twist_base.linear[0] * frame.twist_base.angular[2] * 0.002);
}

INSTANTIATE_TEST_SUITE_P(MujocoPlantTest, RollsTrue, testing::Values(0.01, 0.002, 0.001, 0.0005));

TEST_F(MujocoPlantTest, TwistIsInBaseAxes) {
  auto plant = started();
  speed_up(*plant, -3, 3);  // half a turn and more on the spot
  speed_up(*plant, 5, 5);
  const TruthFrame frame = truth(*plant);
  EXPECT_NEAR(frame.twist_base.linear[0], 0.5, 0.0005);
  EXPECT_NEAR(frame.twist_base.linear[1], 0, 0.0005);
}

TEST_F(MujocoPlantTest, AMirroredWheelDrivesBackwardsWithPositiveSpeed) {
  auto plant = started(
      diffbot_with("<joint name=\"right_wheel_joint\"", "<axis xyz=\"0 1 0\"/>", "<axis xyz=\"0 -1 0\"/>"), kFlat);
  speed_up(*plant, 5, -5);
  EXPECT_NEAR(truth(*plant).twist_base.linear[0], 0.5, 0.001);
}

TEST_F(MujocoPlantTest, GyroShowsTheYawRateInItsOwnAxes) {
  const double rotated = M_PI / 2;  // about x: the IMU's y points up
  auto plant = started(diffbot_with("<joint name=\"imu_joint\"", "xyz=\"0.05 0.02 0.06\"",
                                    "xyz=\"0.05 0.02 0.06\" rpy=\"" + std::to_string(rotated) + " 0 0\""),
                       kFlat);
  speed_up(*plant, -2, 2);
  const double yaw_rate = truth(*plant).twist_base.angular[2];
  const ImuSample imu = sensors(*plant).imu;
  EXPECT_NEAR(imu.angular_velocity[1], yaw_rate, 1e-6);
  EXPECT_NEAR(imu.angular_velocity[2], 0, 1e-6);
  EXPECT_NEAR(imu.linear_acceleration[1], kEarthGravity, 0.01);
}

// The SensorFrame holds the velocity at t_k and the acceleration of [t_k-1, t_k). Under a torque that changes every
// tick the two agree only if they belong to the same interval. The bound is 2 % of the 4 m/s² steps, for pitching on
// the contact's compliance.
TEST_F(MujocoPlantTest, AccelerationBelongsToTheIntervalThatEndsAtTheSample) {
  auto plant = started();
  double before = truth(*plant).twist_base.linear[0];
  for (int k = 0; k < 200; ++k) {
    const double torque = (k * k) % 5 - 2.0;
    plant->write(both(effort_command(torque), effort_command(torque)));
    const double after = truth(*plant).twist_base.linear[0];
    EXPECT_NEAR(sensors(*plant).imu.linear_acceleration[0], (after - before) / 0.001, 0.08) << "cycle " << k + 1;
    before = after;
  }
}

TEST_F(MujocoPlantTest, AccelerationOfALongPeriodIsItsMean) {
  auto plant = started(kFlat, 0.01);
  double before = truth(*plant).twist_base.linear[0];
  for (int k = 0; k < 20; ++k) {
    const double target = k % 4;
    plant->write(both(velocity_command(target), velocity_command(target)));
    const double after = truth(*plant).twist_base.linear[0];
    EXPECT_NEAR(sensors(*plant).imu.linear_acceleration[0], (after - before) / 0.01, 0.08) << "cycle " << k + 1;
    before = after;
  }
}

// In free space a wheel's angular momentum gives the mean torque: J (Δq̇ + Δω_y) = τ T.
TEST_F(MujocoPlantTest, EffortIsTheMeanOverThePeriod) {
  const std::string space = scene_file("space.xml", R"(<mujoco><option gravity="0 0 0"/><worldbody>
    <site name="start"/></worldbody></mujoco>)");
  auto plant = started(diffbot_urdf(), space, 0.01);
  for (int k = 0; k < 20; ++k) {
    const auto rate = [&] { return truth(*plant).joints[0].velocity + truth(*plant).twist_base.angular[1]; };
    const double before = rate();
    plant->write(both(velocity_command(k % 4), velocity_command(k % 4)));
    EXPECT_NEAR(sensors(*plant).joints[0].effort * 0.01, 0.005 * (rate() - before), 1e-9) << "cycle " << k;
  }
}

class HardStop : public PlantTest, public testing::WithParamInterface<double> {};

// v²/(2a), a half of what lifts the rear, 9.81 · 0.0602 / 0.0890 / 2 = 3.32 m/s²: 0.151 m; the soft landing adds some
// mm.
TEST_P(HardStop, StopsFromOneMetrePerSecondWithoutTipping) {
  auto plant = started();
  speed_up(*plant, GetParam() / kRadius, GetParam() / kRadius);
  const double start = truth(*plant).pose_world.position[0];
  double pitch = 0;
  for (int i = 0; i < 3000; ++i) {
    plant->write(brakes_);
    pitch = std::max(pitch, std::abs(2 * std::asin(truth(*plant).pose_world.orientation[1])));
  }
  EXPECT_LT(pitch, 10 * M_PI / 180);
  EXPECT_NEAR(std::abs(truth(*plant).pose_world.position[0] - start), 0.151, 0.005);
  EXPECT_NEAR(truth(*plant).twist_base.linear[0], 0, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(MujocoPlantTest, HardStop, testing::Values(1.0, -1.0));

TEST_F(MujocoPlantTest, CommandsForAnotherNumberOfJointsBrake) {
  auto plant = started();
  const std::array<JointCommand, 1> one{effort_command(3)};
  for (int i = 0; i < 100; ++i) plant->write(one);
  EXPECT_LT(std::abs(truth(*plant).twist_base.linear[0]), 1e-5);
}

struct Repeats : PlantTest, testing::WithParamInterface<double> {
  // Everything that is read during a drive, as bytes.
  std::string record(MujocoPlant& plant) const {
    std::string bytes;
    for (int k = 0; k < 2000; ++k) {
      const JointCommand left = k % 7 == 0 ? JointCommand{} : velocity_command(k % 11 - 4);
      plant.write(both(left, effort_command(0.1 * (k % 13 - 6))));
      const SensorFrame seen = sensors(plant);
      const TruthFrame real = truth(plant);
      bytes.append(reinterpret_cast<const char*>(&seen), sizeof seen);
      bytes.append(reinterpret_cast<const char*>(&real), sizeof real);
    }
    return bytes;
  }
};

TEST_P(Repeats, BitForBitInAnotherPlantAndAfterStart) {
  auto plant = started(kSlope, GetParam());
  const std::string first = record(*plant);
  EXPECT_TRUE(first == record(*started(kSlope, GetParam())));
  plant->start();
  EXPECT_TRUE(first == record(*plant));
}

INSTANTIATE_TEST_SUITE_P(MujocoPlantTest, Repeats, testing::Values(0.01, 0.002, 0.001, 0.0005));

}  // namespace robot_control::tests
