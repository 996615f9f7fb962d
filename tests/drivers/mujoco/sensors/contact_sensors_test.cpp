/// The forces of the ground on the wheels hold whatever stands, accelerates and leans. diffbot's centre of gravity is
/// 0.06 m behind the axle and its ball caster 0.25 m, so the wheels carry 0.76 of the weight.

#include <Eigen/Geometry>

#include "drivers/mujoco/plant_fixture.h"
#include "machine/gravity.h"
#include "support/allocation_guard.h"
#include "support/robots/corpus.h"

namespace robot_control::tests {

struct ContactSensors : PlantTest, testing::WithParamInterface<TyreModel> {
  ContactSensors() {
    parameters_.scene = kFlat;
    parameters_.sensor_errors = ErrorLevel::kIdeal;
    parameters_.contact_sensors = true;
    parameters_.tyre = GetParam();
  }
  std::unique_ptr<MujocoPlant> sensing() const {
    auto plant = std::make_unique<MujocoPlant>(robot_, parameters_, period_);
    plant->start();
    return plant;
  }
  static Eigen::Vector3d sum(const SensorFrame& frame) {
    Eigen::Vector3d total = Eigen::Vector3d::Zero();
    for (const ContactSample& contact : frame.contacts) {
      total += Eigen::Map<const Eigen::Vector3d>(contact.force.data());
    }
    return total;
  }

  static constexpr double kOnWheels = 0.76;
  DriveTrain robot_ = read_drive_train(diffbot_urdf(), {});
  const double weight_ = robot_.mass * kGravity;
  MujocoPlantParameters parameters_;
};

TEST_P(ContactSensors, FeelTheWeightThatStandsOnTheWheels) {
  const SensorFrame frame = sensors(*sensing());
  EXPECT_EQ(frame.contact_count, 2u);
  EXPECT_EQ(frame.contacts[1].valid, 1u);
  // Wheels and caster sink in by different micrometres, which changes the load by less than a thousandth.
  for (const std::size_t wheel : {0u, 1u})
    EXPECT_NEAR(frame.contacts[wheel].force[2], kOnWheels * weight_ / 2, 1e-3 * weight_);
  EXPECT_NEAR(sum(frame)[0], 0, 1e-3 * weight_);
  EXPECT_NEAR(sum(frame)[1], 0, 1e-3 * weight_);
  for (std::size_t i = 2; i < kMaxContacts; ++i) EXPECT_EQ(frame.contacts[i].force, Vector3{}) << "no wheel";
}

// The wheels' friction alone accelerates the robot: F = m a.
TEST_P(ContactSensors, FeelWhatPushesTheRobotForward) {
  auto plant = sensing();
  hold(*plant, both(effort_command(0.5), effort_command(0.5)), 0.5);
  const double before = truth(*plant).twist_base.linear[0];
  double force = 0;
  constexpr int kSteps = 200;
  for (int i = 0; i < kSteps; ++i) {
    plant->write(both(effort_command(0.5), effort_command(0.5)));
    force += sum(sensors(*plant))[0] / kSteps;
  }
  const double acceleration = (truth(*plant).twist_base.linear[0] - before) / (kSteps * period_);
  EXPECT_GT(acceleration, 0.5);
  EXPECT_NEAR(force, robot_.mass * acceleration, 0.01 * robot_.mass * acceleration);
}

// On a slope α the brakes hold m g sin α; the wheels' share of m g cos α moves by the height of the centre of gravity,
// 0.089 m of 0.25 m times m g sin α, towards the caster.
TEST_P(ContactSensors, FeelTheSlopeInTheAxesOfTheBase) {
  constexpr double kAngle = 0.1;
  parameters_.slope = kAngle;
  const Eigen::Vector3d total = sum(sensors(*sensing()));
  EXPECT_NEAR(total[0], weight_ * std::sin(kAngle), 2e-3 * weight_);
  EXPECT_NEAR(total[2], weight_ * (kOnWheels * std::cos(kAngle) - 0.089 / 0.25 * std::sin(kAngle)), 2e-3 * weight_);
}

TEST_P(ContactSensors, FeelNothingInTheAir) {
  parameters_.push_z = 3 * weight_;
  parameters_.push_duration = 0.2;
  auto plant = sensing();
  hold(*plant, brakes_, 0.2);
  EXPECT_EQ(sum(sensors(*plant)).norm(), 0);
  EXPECT_EQ(sensors(*plant).contacts[0].valid, 1u);
}

TEST_P(ContactSensors, ChangeNothingElse) {
  auto sensing_one = sensing();
  parameters_.contact_sensors = false;
  auto other = sensing();
  for (int i = 0; i < 500; ++i) {
    const auto commands = both(effort_command(0.5), effort_command(0.4));
    sensing_one->write(commands);
    other->write(commands);
  }
  EXPECT_EQ(truth(*sensing_one).pose_world.position, truth(*other).pose_world.position);
  EXPECT_EQ(sensors(*other).contact_count, 0u);
  EXPECT_EQ(sensors(*other).contacts[0].valid, 0u);
  EXPECT_EQ(sum(sensors(*other)).norm(), 0);
}

// pmb2 rests on two wheels and four casters: together they carry all of it.
TEST_P(ContactSensors, FeelTheCastersBehindTheWheels) {
  if (corpus().empty()) GTEST_SKIP() << kNoCorpus;
  setenv("ROS_PACKAGE_PATH", (corpus() / "pmb2").c_str(), 1);
  robot_ = read_drive_train(load_description((corpus() / "pmb2/robot.urdf").string()), {});
  ASSERT_EQ(robot_.wheels.size() + robot_.casters.size(), 6u);
  const SensorFrame frame = sensors(*sensing());
  EXPECT_NEAR(sum(frame)[2], robot_.mass * kGravity, 1e-3 * robot_.mass * kGravity);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_GT(frame.contacts[i].force[2], 0) << i;
}

TEST_P(ContactSensors, NeverAllocate) {
  parameters_.battery_voltage = 24;
  auto plant = sensing();
  SensorFrame frame;
  const AllocationGuard guard;
  for (int i = 0; i < 100; ++i) {
    plant->read(frame);
    plant->write(brakes_);
  }
  EXPECT_EQ(guard.count(), 0u);
}

INSTANTIATE_TEST_SUITE_P(Tyres, ContactSensors, testing::Values(TyreModel::kBrush, TyreModel::kNative),
                         [](const auto& tyre) { return tyre.param == TyreModel::kBrush ? "brush" : "native"; });

}  // namespace robot_control::tests
