/// bench_legs_recording URDF PERIOD IN OUT: estimates the way of a robot on legs from recorded sensors.
///
/// IN and OUT hold rows of doubles in the machine's byte order, one per PERIOD seconds. The one is written, and the
/// other judged, by bench/odometry/recorded_walks.py.
///
/// | columns of IN | |
/// |---|---|
/// | gyro, accelerometer | 3 rad/s, 3 m/s² |
/// | angles and rates of the joints, in the order of LegModel | 12 rad, 12 rad/s |
/// | share of the weight on each foot | 4 |
/// | contact schedule | 4 |
///
/// | columns of OUT | |
/// |---|---|
/// | position, orientation | 3 m, 4 (x y z w) |
/// | velocity in base axes | 3 m/s |
/// | covariance of the pose | 36 |
/// | position of the plain estimate | 3 m |

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <vector>

#include "bench/programs/rows.h"
#include "estimation/legged/legged_estimator.h"
#include "machine/description/robot_description.h"
#include "machine/gravity.h"
#include "machine/legs/leg_dynamics.h"

namespace robot_control::bench {
namespace {

constexpr std::size_t kIn = 38;

SensorFrame frame_of(const double* row, std::uint64_t cycle, double weight) {
  SensorFrame sensors;
  sensors.head.cycle = cycle;
  sensors.valid = kValidGyro | kValidAccelerometer;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    sensors.imu.angular_velocity[axis] = row[axis];
    sensors.imu.linear_acceleration[axis] = row[3 + axis];
  }
  sensors.joint_count = kLegsJoints;
  for (std::size_t i = 0; i < kLegsJoints; ++i) {
    JointSample& joint = sensors.joints[i];
    joint.valid = kValidMotion;
    joint.position = row[6 + i];
    joint.velocity = row[18 + i];
  }
  sensors.contact_count = kLegs;
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    sensors.contacts[leg] = {.force = {0, 0, row[30 + leg] * weight}, .valid = 1};
    sensors.gate.contact_schedule[leg] = row[34 + leg];
  }
  return sensors;
}

}  // namespace

int run(int argc, char** argv) {
  if (argc != 5) {
    std::fprintf(stderr, "usage: bench_legs_recording URDF PERIOD IN OUT\n");
    return 1;
  }
  const LegModel model = read_legs(load_description(argv[1]), {}, {});
  const double weight = LegDynamics(model).mass() * kGravity;
  LeggedEstimator estimator(model, std::strtod(argv[2], nullptr));
  std::ifstream in(argv[3], std::ios::binary);
  std::ofstream out(argv[4], std::ios::binary);
  std::vector<double> row(kIn);
  const auto write = [&](const double* values, std::size_t count) {
    out.write(reinterpret_cast<const char*>(values), static_cast<std::streamsize>(count * sizeof(double)));
  };
  StateFrame state;
  for (std::uint64_t cycle = 0; in.read(reinterpret_cast<char*>(row.data()), kIn * sizeof(double)); ++cycle) {
    estimator.step(frame_of(row.data(), cycle, weight), state);
    const BaseState& base = state.base;
    write(base.pose_odom.position.data(), 3);
    write(base.pose_odom.orientation.data(), 4);
    write(base.twist_base.linear.data(), 3);
    write(base.pose_covariance.data(), 36);
    write(estimator.state().plain.position.data(), 3);
  }
  if (!out.good()) return 1;
  print("legs_recording", {});
  return 0;
}

}  // namespace robot_control::bench

int main(int argc, char** argv) {
  return robot_control::bench::run(argc, argv);
}
