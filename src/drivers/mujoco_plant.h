#pragma once
/// The simulated machine: robot and scene in MuJoCo.
///
/// A period is n = ⌈period / 1 ms⌉ MuJoCo steps of period/n. `write` does for each of them
///
///   wheels: joint law (q, q̇ → τ), motor, tyre friction  →  mj_step2 (accelerations, integration)
///   →  mj_step1 (kinematics of the new state)
///
/// and collects what `read` and `truth` hand out, so that after `write` k everything describes t_k+1: positions,
/// velocities and gyro at that instant; accelerometer (specific_force.h), contact forces and efforts as means over
/// [t_k, t_k+1), as SensorFrame promises. Joints that are no wheels take no commands (JointRole): passive ones move
/// freely, held ones stand by friction.
///
/// `start` sets the robot down on the site `start` of the scene and lets it settle with the brakes on, at most for
/// 20 s; where it then rests is time zero and the origin of truth. It rests when its base has moved slower than
/// 1 µm/s and 1 µrad/s, its joints than 1 mrad/s (an unloaded swivel takes long, and does not matter), for 0.1 s;
/// or at last when the base is slower than 30 µm/s and 30 µrad/s. A robot that tilts by more than 30° falls over, and
/// is refused; the driver then stays in state kStarting. Same model and commands, same bits, also after another
/// `start`.
///
/// A push acts on the base's origin from push_start for push_duration after time zero.
///
/// Faults: a warning of MuJoCo is kFaultSimulationDiverged, an error kFaultSimulationError, NaN or infinity in what
/// would be handed out kFaultNotFinite. The simulation then stands; `read` and `truth` keep the last good values,
/// with state kFault and nothing valid. `start` recovers from all but an error, which is for good.
///
/// With native friction there is a known error: MuJoCo drives the slip of a wheel to zero with the time constant T/2
/// of `solref` (T = 4 ms) but leaves out the turning of the contact's frame (J̇q̇). In a curve at v, ω the robot
/// therefore moves sideways with v ω T/2, outwards: 0.2 mm/s at 0.5 m/s and 0.2 rad/s.
///
/// Between command and torque: actuator_delay, injected faults (motor_faults.h), the motor's torque–speed line
/// (motor.h). Between state and `read`: sensor errors and delay (sensor_errors.h), injected faults (sensor_faults.h).
/// Truth stands before all of them. `start` takes all injected faults back.
///
/// Sensors: encoders of all joints, gyro and accelerometer at the IMU; where the parameters say so, the forces of the
/// ground on wheels and casters (wheel_contacts.h), and a battery (battery.h) that feeds all wheels. An e-stop button
/// that is not pressed, except by an injected fault.

#include <array>
#include <string>
#include <vector>

#include "drivers/contact/wheel_contacts.h"
#include "drivers/model/mujoco_model.h"
#include "drivers/motors/joint_law.h"
#include "drivers/motors/motor.h"
#include "drivers/motors/motor_faults.h"
#include "drivers/mujoco_plant_parameters.h"
#include "drivers/sensors/sensor_errors.h"
#include "drivers/sensors/sensor_faults.h"
#include "drivers/sensors/specific_force.h"
#include "hal/driver.h"
#include "robot/robot_model.h"

namespace robot_control {

class MujocoPlant final : public Driver {
 public:
  /// `period` in s. Throws DriverError: see compile_model, WheelContacts and brake_of.
  MujocoPlant(const RobotModel& robot, const MujocoPlantParameters& parameters, double period);

  void start() override;
  void read(SensorFrame& sensors) noexcept override;
  void write(std::span<const JointCommand> commands) noexcept override;
  void stop() noexcept override;
  bool simulated() const noexcept override { return true; }
  bool truth(TruthFrame& truth) noexcept override;
  bool inject(const InjectedFaults& faults) noexcept override;

  /// MuJoCo's message about the fault; "" without one.
  const char* fault_message() const noexcept { return fault_message_.data(); }

  /// "left_wheel_joint bears no load at rest, on the ground stand skid": of the first `start`; "" where all drive
  /// wheels carry.
  const std::string& unloaded() const noexcept { return unloaded_; }

  /// For tests and tools: model and data. Null data before `start`.
  const MujocoModel& model() const noexcept { return model_; }
  const mjData* data() const noexcept { return data_.get(); }

 private:
  static void substep(void* plant);
  std::span<const JointCommand> received(std::span<const JointCommand> commands) noexcept;
  void simulate(std::span<const JointCommand> commands) noexcept;
  bool advance(std::span<const JointCommand> commands) noexcept;
  void set_origin();
  void settle();
  void push() noexcept;
  void collect() noexcept;
  void collect_truth() noexcept;
  void measure() noexcept;
  bool finite() const noexcept;
  std::uint64_t equipped() const noexcept;
  void fail(std::uint64_t fault, const char* message) noexcept;

  MujocoModel model_;
  MujocoData data_;
  WheelContacts wheels_;
  MujocoPlantParameters parameters_;
  std::vector<JointLaw> laws_;  ///< per drive wheel
  std::vector<Motor> motors_;   ///< per drive wheel
  MotorFaults motor_faults_;
  SpecificForce specific_force_;
  SensorErrors sensor_errors_;
  SensorFaults sensor_faults_;
  std::vector<JointCommand> brakes_;
  std::array<double, 7> origin_{};  ///< of truth: position, quaternion w x y z
  std::array<double, 3> push_{};    ///< N, world axes
  bool settled_ = false;
  bool has_rested_ = false;
  std::string unloaded_;

  DriverState state_ = DriverState::kStarting;
  std::uint64_t faults_ = 0;
  std::array<char, 256> fault_message_{};
  bool stopped_ = false;

  // sums over the steps of a period
  std::array<double, kMaxJoints> effort_sum_{};
  std::array<double, kMaxWheels> normal_force_sum_{};
  Eigen::Vector3d specific_force_sum_ = Eigen::Vector3d::Zero();
  std::array<Eigen::Vector3d, kMaxContacts> force_sum_{};
  double power_sum_ = 0;

  using Commands = std::array<JointCommand, kMaxJoints>;
  Commands received_{};
  DelayLine<Commands, kMaxDelay> actuator_delay_;
  InjectedFaults injected_{};
  std::uint64_t cycle_ = 0;  ///< writes since `start`

  // of t_k
  Measurement exact_;
  Measurement measured_;    ///< with its errors
  Measurement handed_out_;  ///< with its faults, once it was read
  bool read_ = false;
  std::uint64_t lost_ = 0;  ///< SensorValidity bits taken by faults
  TruthFrame truth_;
};

}  // namespace robot_control
