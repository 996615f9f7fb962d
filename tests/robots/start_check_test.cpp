#include "robots/wheeled/start_check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "control/wheeled/smooth_speed.h"
#include "loop/cycle_fixture.h"
#include "loop/processes/process.h"

namespace robot_control::tests {

TEST(Identity, DiffersByRateAndClock) {
  LoopParameters loop;
  LoopParameters slower = loop;
  slower.rate = 500;
  LoopParameters lockstep = loop;
  lockstep.clock = ClockMode::kLockstep;
  const DriveTrain robot = two_wheels();
  EXPECT_EQ(identified(robot, loop).hash, identified(robot, loop).hash);
  EXPECT_NE(identified(robot, loop).hash, identified(robot, slower).hash);
  EXPECT_NE(identified(robot, loop).hash, identified(robot, lockstep).hash);
  EXPECT_EQ(identified(robot, slower).source, "test at 500 Hz, clock wall");
}

TEST(StartCheck, RefusesGainsThatAreUnstableOnThisRobot) {
  Parameters parameters;
  EXPECT_NO_THROW(require_drivable(parameters, two_wheels()));
  parameters.controller.pid_kp = 20;
  EXPECT_THROW(require_drivable(parameters, two_wheels()), ParameterError);
}

TEST(NoteOnSlowDriving, NamesTheCountsAndTheSpeed) {
  Parameters parameters;
  parameters.estimator.encoder_noise = 2 * std::numbers::pi / 64 / std::sqrt(12.0);
  const std::string note = note_on_slow_driving(parameters, two_wheels());
  const double speed = smooth_speed(parameters.controller, two_wheels(), 2 * std::numbers::pi / 64, 1e-3);
  std::ostringstream text;
  text << std::setprecision(2) << speed << " m/s";
  EXPECT_NE(note.find("64 counts"), std::string::npos) << note;
  EXPECT_NE(note.find(text.str()), std::string::npos) << note;
}

TEST(NoteOnSlowDriving, IsNoneOfFineEncoders) {
  EXPECT_EQ(note_on_slow_driving(Parameters(), two_wheels()), "");
}

}  // namespace robot_control::tests
