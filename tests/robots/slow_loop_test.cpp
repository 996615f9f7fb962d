#include "robots/wheeled/slow_loop.h"

#include "gate/wheeled/wheel_stop.h"
#include "support/matchers.h"
#include "support/robots/diffbot_urdf.h"

namespace robot_control::tests {

constexpr Role kRoles4[] = {Role::kDriver, Role::kEstimator, Role::kController, Role::kMonitor};

DriveTrain diffbot() {
  return read_drive_train(diffbot_urdf(), {});
}

Parameters at(double rate) {
  Parameters parameters;
  parameters.loop.rate = rate;
  return parameters;
}

TEST(SlowLoop, IsNotedBelowThePromisedRateAlone) {
  for (const Role role : kRoles4) EXPECT_THAT(wheeled_rate_notes(at(100), diffbot(), role), IsEmpty());
  EXPECT_THAT(wheeled_rate_notes(at(50), diffbot(), Role::kController),
              ElementsAre(HasSubstr("at robot.rate = 50 Hz, the wheel loops correct")));
  EXPECT_THAT(wheeled_rate_notes(at(20), diffbot(), Role::kMonitor),
              ElementsAre(HasSubstr("recognised after 25 rad, motion without a command after 20 s")));
}

// Gains and brakes are proportional to the rate.
TEST(SlowLoop, CorrectsAndBrakesInAnInverseProportionToTheRate) {
  EXPECT_NEAR(correction_time(at(20), diffbot()), 2.5 * correction_time(at(50), diffbot()), 1e-9);
  EXPECT_NEAR(brake_time(diffbot(), 0.05), 2.5 * brake_time(diffbot(), 0.02), 1e-9);
  const DriveTrain robot = diffbot();
  const double damping = brakes_of_slow_drives(robot, 0.05)[0].damping;
  EXPECT_NEAR(brake_time(robot, 0.05), straight_inertia(robot, robot.wheels[0]) / damping, 1e-12);
}

TEST(SlowLoop, IsNotedOfADriverWhereTorquesBrake) {
  Parameters parameters = at(20);
  EXPECT_THAT(wheeled_rate_notes(parameters, diffbot(), Role::kDriver), IsEmpty()) << "the simulator brakes by itself";
  parameters.drives = "odrive.yaml";
  EXPECT_THAT(wheeled_rate_notes(parameters, diffbot(), Role::kDriver),
              ElementsAre(HasSubstr("brake the robot with a time constant of")));
}

}  // namespace robot_control::tests
