#pragma once
/// These functions measure one robot with one seed, in the closed loop on the simulated machine.

#include <cstdint>

#include "bench/programs/legs/worst_values.h"
#include "support/robots/quadruped_loop.h"

namespace robot_control::bench {

/// Lying → standing → lying, with the sensor errors of the field.
void postures(const LegModel& model, std::uint64_t seed, WorstValues& worst);
/// The body follows sines of 0.5 Hz on each axis.
void body_pose(const LegModel& model, std::uint64_t seed, WorstValues& worst);
/// Each foot draws a circle of 5 cm radius in 2 s while the others stand.
void circle(const LegModel& model, std::uint64_t seed, WorstValues& worst);

/// An e-stop while the robot stands, sways, and has one foot in the air.
void stop(const LegModel& model, std::uint64_t seed, WorstValues& worst);
/// A push in 8 directions while the robot stands, and then the brake.
void push(const LegModel& model, std::uint64_t seed, WorstValues& worst);
/// Ten minutes without power in the joints, after an e-stop.
void rest(const LegModel& model, std::uint64_t seed, WorstValues& worst);
/// The controller is silent for 5 … 19 cycles while the robot sways.
void silent(const LegModel& model, std::uint64_t seed, WorstValues& worst);

/// An hour of standing, swaying, lifting feet, lying down and standing up, with the sensor errors of the field.
void hour(const LegModel& model, std::uint64_t seed, WorstValues& worst);
/// Runs with failing nodes, stops and resets, computed again from their rows.
void replayed(const LegModel& model, std::uint64_t seed, WorstValues& worst);
/// The same of a robot that walks, with gaits that change.
void walking_replayed(const LegModel& model, std::uint64_t seed, WorstValues& worst);

/// The time of each law's step, its allocations, and the time of a cycle of ClosedLoop beside that of a bare mj_step.
void cost(const LegModel& model, std::uint64_t seed, WorstValues& worst);
/// The time of estimator and controller in a trot of 0.5 m/s. Each cycle of the controller counts with its fastest
/// block; of these follow the median, that of cycles with a plan, and the 99th percentile. A cycle of ClosedLoop is as
/// in `cost`.
void walking_cost(const LegModel& model, std::uint64_t seed, WorstValues& worst);

/// The estimate against the truth, with the errors of the field and without foot sensors: a line, a square, an eight,
/// tiles, other gaits. Then climbs of 1 m.
void odometry(const LegModel& model, std::uint64_t seed, WorstValues& worst);
/// Touchdowns that the estimator finds without foot sensors.
void contact(const LegModel& model, std::uint64_t seed, WorstValues& worst);

/// Trots at four speeds, sideways, turning and on all axes. Each walk ends with a zero. The sensors have the errors of
/// data sheets, and the feet no force sensors. The next three rows have the same sensors.
void trot(const LegModel& model, std::uint64_t seed, WorstValues& worst);
/// Crawl and walking trot.
void gaits(const LegModel& model, std::uint64_t seed, WorstValues& worst);
/// A trot of 0.5 m/s.
void robots(const LegModel& model, std::uint64_t seed, WorstValues& worst);
/// An e-stop at three speeds, in a crawl, sideways and while it turns. The seed chooses one of 40 phases of the gait.
void walking_stop(const LegModel& model, std::uint64_t seed, WorstValues& worst);

/// 100 changes among all gaits, at random times and speeds.
void switches(const LegModel& model, std::uint64_t seed, WorstValues& worst);
/// A trot of 0.3 m/s that is pushed in 8 directions. Then with a payload, on slippery ground, with motors that are late
/// or weak, and with masses that are not the described ones. The seed chooses one of 24 phases of the gait for the
/// push.
void disturbances(const LegModel& model, std::uint64_t seed, WorstValues& worst);
/// Kicks of 20 N·s on 12.7 kg within 0.1 s, in eight directions, against trots of 0.3 and 1.0 m/s, with the errors of
/// the field. The seed chooses one of 24 phases of the gait.
void kicks(const LegModel& model, std::uint64_t seed, WorstValues& worst);
/// The largest push of 0.1 s, in steps of 5 N·s on 12.7 kg, with which and with all smaller ones a robot walks on.
/// Eight directions, 0° to the front and 90° to the left, for each gait.
void push_limits(const LegModel& model, std::uint64_t seed, WorstValues& worst);
/// A trot of 0.5 m/s with each fault of each encoder, of each motor and of the IMU. The seed chooses one of 20 phases
/// of the gait. A fault is named if the first cause of the stop comes in time and names its joint, or the IMU.
void faults(const LegModel& model, std::uint64_t seed, WorstValues& worst);
/// The same on a slope of 10° and on tiles of ±3 cm.
void faults_uneven(const LegModel& model, std::uint64_t seed, WorstValues& worst);
/// Ten minutes of walking with random gaits and twists, in stretches between two resets of the odometry.
void walking_hours(const LegModel& model, std::uint64_t seed, WorstValues& worst);
/// The controller is silent for 5 … 19 cycles at 200 phases of a trot of 1.0 m/s.
void walking_silent(const LegModel& model, std::uint64_t seed, WorstValues& worst);

/// Random walks at full speed with random poses of the body (support/robots/quadruped_trials.h).
void leaning_walks(const LegModel& model, std::uint64_t seed, WorstValues& worst);
/// The same without poses, with first joints that need 0.97 of their torque for half of the weight.
void weak_hips(const LegModel& model, std::uint64_t seed, WorstValues& worst);
/// A robot that lies on slopes of 10, 15 and 20° is to stand up. The seed chooses one of eight headings.
void slopes(const LegModel& model, std::uint64_t seed, WorstValues& worst);

/// Walks of 0.4 m/s over a course, with the errors of the field. Five consecutive seeds begin at five places and
/// headings. Heights are those of a leg of kReferenceLeg. A step up, and down again.
void steps(const LegModel& model, std::uint64_t seed, WorstValues& worst);
/// Five stairs up, and down again.
void stairs(const LegModel& model, std::uint64_t seed, WorstValues& worst);
/// Rough floors, bars, a gap and a patch of ice.
void terrain(const LegModel& model, std::uint64_t seed, WorstValues& worst);

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kSway = 0.5;            ///< Hz
inline constexpr double kTurnedOver = kPi / 3;  ///< rad

/// Returns the errors of data sheets, and feet without force sensors.
inline Parameters walking_parameters(std::uint64_t seed) {
  Parameters parameters = QuadrupedLoop::parameters(seed, ErrorLevel::kDataSheet);
  parameters.plant.contact_sensors = false;
  return parameters;
}

/// Stands up, and stands for half a second.
inline void stand_up(QuadrupedLoop& robot) {
  robot.wait(0.3);
  robot.run(2.5, stance({ModeKind::kStand}));
  robot.run(0.5, {});
  robot.clear();
}

}  // namespace robot_control::bench
