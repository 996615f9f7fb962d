#pragma once
/// MujocoPlant is the simulated machine: robot and scene in MuJoCo.
///
/// A period consists of n = ⌈period / 1 ms⌉ MuJoCo steps of period/n. For each of them `write` runs
///
///   driven and held joints: joint law (q, q̇ → τ), motor; wheels: tyre friction
///   →  mj_step2 (accelerations, integration)  →  mj_step1 (kinematics of the new state)
///
/// and collects the values for `read` and `truth`. After `write` k they describe t_k+1, as SensorFrame requires:
/// positions, velocities and gyro at that time. Accelerometer (specific_force.h), contact forces and efforts are means
/// over [t_k, t_k+1). Passive joints move freely. Held ones have a motor, too, and brake, because no controller
/// commands them otherwise.
///
/// `start` places the robot on the site `start` of the scene, with its joints at JointModel::rest_position. It lets it
/// settle with the brakes on, for at most 20 s. Its place at rest is the origin of truth, and its time is zero. It is
/// at rest when for 0.1 s its base has been slower than 1 µm/s and 1 µrad/s and its joints than 1 mrad/s. After 20 s a
/// base slower than 30 µm/s and 30 µrad/s also counts, because an unloaded swivel moves for long without effect. A
/// robot that tilts by more than 30° falls over and is refused; the driver then stays in state kStarting. The same
/// model and commands give the same bits, also after another `start`.
///
/// A push acts on the base's origin from push_start for push_duration after time zero.
///
/// A warning of MuJoCo causes kFaultSimulationDiverged, an error kFaultSimulationError, NaN or infinity in the results
/// kFaultNotFinite. The simulation then stops. `read` and `truth` keep the last good values, with state kFault and
/// nothing valid. `start` recovers from all faults except an error, which is permanent.
///
/// Native friction has a known error. MuJoCo drives the slip of a wheel to zero with the time constant T/2 of `solref`
/// (T = 4 ms), but omits the rotation of the contact's frame (J̇q̇). In a curve at v, ω the robot therefore moves
/// outwards with v ω T/2: 0.2 mm/s at 0.5 m/s and 0.2 rad/s.
///
/// With drive `velocity` each drive wheel has the law of velocity_drive.h, and its torque is not measured.
///
/// A command passes actuator_delay, injected faults (motor_faults.h) and the motor's torque–speed line (motor.h). The
/// state passes sensor errors and delay (sensor_errors.h) and injected faults (sensor_faults.h) before `read`. Truth is
/// the state itself. `start` removes all injected faults.
///
/// The sensors are encoders at all joints, gyro and accelerometer at the IMU, and an e-stop button, which only an
/// injected fault presses. The parameters can add a laser scanner (laser.h). They can also add a battery (battery.h)
/// that feeds all motors, and the ground's forces (wheel_contacts.h; body_contacts.h for a machine without wheels).

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "drivers/driver.h"
#include "drivers/joint_law.h"
#include "drivers/mujoco/contact/body_contacts.h"
#include "drivers/mujoco/contact/wheel_contacts.h"
#include "drivers/mujoco/model/mocap_paths.h"
#include "drivers/mujoco/model/mujoco_model.h"
#include "drivers/mujoco/motors/motor.h"
#include "drivers/mujoco/motors/motor_faults.h"
#include "drivers/mujoco/motors/velocity_drive.h"
#include "drivers/mujoco/mujoco_plant_parameters.h"
#include "drivers/mujoco/sensors/laser.h"
#include "drivers/mujoco/sensors/sensor_errors.h"
#include "drivers/mujoco/sensors/sensor_faults.h"
#include "drivers/mujoco/sensors/specific_force.h"
#include "machine/machine_model.h"

namespace robot_control {

class MujocoPlant final : public Simulator {
 public:
  /// `period` is in s. Throws DriverError as compile_model, WheelContacts and brake_of do.
  MujocoPlant(const MachineModel& robot, const MujocoPlantParameters& parameters, double period);

  void start() override;
  void read(SensorFrame& sensors) noexcept override;
  void write(std::span<const JointCommand> commands) noexcept override;
  void stop() noexcept override { stopped_ = true; }
  bool accepts(JointMode mode) const noexcept override {
    const bool own_loops = parameters_.drive == SimulatedDrive::kVelocity;
    return own_loops ? mode == JointMode::kBrake || mode == JointMode::kDriveVelocity : JointLaw::computes(mode);
  }
  bool measures(MachineInput input) const noexcept override {
    return input != MachineInput::kJointEffort || parameters_.drive == SimulatedDrive::kTorque;
  }
  void truth(TruthFrame& truth) noexcept override;
  void inject(const InjectedFaults& faults) noexcept override { injected_ = faults; }
  std::uint64_t scan_cycles() const noexcept override;
  std::unique_ptr<Simulator> clone() const override;
  LaserScan scan(const TruthFrame& truth) override { return laser_ ? laser_->scan(truth) : LaserScan{}; }

  /// Returns MuJoCo's message about the fault.
  std::string_view fault_message() const noexcept override { return fault_message_.data(); }

  /// Returns for instance "left_wheel_joint bears no load at rest, on the ground stand skid".
  std::string warning() const override { return unloaded_; }

  /// Return model and data for tests and tools; the data are null before `start`.
  const MujocoModel& model() const noexcept { return model_; }
  const mjData* data() const noexcept { return data_.get(); }

 private:
  MujocoPlant(const MujocoPlant& other) = default;  ///< without data and laser of its own
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
  std::shared_ptr<mjData> data_;
  MocapPaths paths_;
  WheelContacts wheels_;
  BodyContacts bodies_;  ///< of a machine without wheels
  MujocoPlantParameters parameters_;
  std::vector<JointLaw> laws_;         ///< per joint of MujocoModel::actuated
  std::vector<VelocityDrive> drives_;  ///< of the drive wheels, the first joints; empty: they have a JointLaw
  std::vector<Motor> motors_;          ///< per joint of MujocoModel::actuated
  MotorFaults motor_faults_;
  SpecificForce specific_force_;
  SensorErrors sensor_errors_;
  SensorFaults sensor_faults_;
  std::vector<JointCommand> brakes_;
  std::array<double, 7> origin_{};  ///< origin of truth: position, quaternion w x y z
  std::array<double, 3> push_{};    ///< N, world axes
  std::shared_ptr<Laser> laser_;    ///< null: there is none, or not yet started
  double period_;                   ///< s
  std::size_t contacts_;            ///< number of bodies whose contact forces can be measured
  bool settled_ = false;
  bool has_rested_ = false;
  std::string unloaded_;

  DriverState state_ = DriverState::kStarting;
  std::uint64_t faults_ = 0;
  std::array<char, 256> fault_message_{};
  bool stopped_ = false;

  // These are sums over the steps of a period.
  std::array<double, kMaxJoints> effort_sum_{};
  std::array<double, kMaxContacts> normal_force_sum_{};  ///< of contacts
  Eigen::Vector3d specific_force_sum_ = Eigen::Vector3d::Zero();
  std::array<Eigen::Vector3d, kMaxContacts> force_sum_{};
  double power_sum_ = 0;

  using Commands = std::array<JointCommand, kMaxJoints>;
  Commands received_{};
  DelayLine<Commands, kMaxDelay> actuator_delay_;
  InjectedFaults injected_{};
  std::uint64_t cycle_ = 0;  ///< writes since `start`

  // These members describe t_k.
  Measurement exact_;
  Measurement measured_;    ///< with the sensors' errors
  Measurement handed_out_;  ///< with the injected faults, after `read`
  bool read_ = false;
  std::uint64_t lost_ = 0;  ///< SensorValidity bits cleared by faults
  TruthFrame truth_;
};

}  // namespace robot_control
