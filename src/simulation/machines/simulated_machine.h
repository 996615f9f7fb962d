#pragma once
/// The simulated machine that the parameters describe is a MuJoCo plant. Its motors are given their torques directly,
/// or they stand behind simulated drives on CAN (Parameters::drives).

#include <memory>
#include <string>
#include <vector>

#include "bus/latest_value.h"
#include "configuration/parameters.h"
#include "drivers/drive/device_front.h"
#include "drivers/driver.h"
#include "drivers/mujoco/mujoco_plant.h"
#include "gate/brake_law.h"
#include "machine/machine_model.h"

namespace robot_control {

/// A DrivenPlant is the simulated robot behind motor drives, in virtual time. The driver of the drives computes torques
/// and messages, the line carries them, the devices turn the motors of the MuJoCo plant. The driver does not know that
/// they are simulated.
///
/// In each period the devices see the wheels move on with the velocity of its beginning. The plant applies the mean
/// torque of a device over the period. IMU, contacts, battery and the other joints are those of the plant. Devices that
/// report the IMU get its samples, and what arrives from them counts. Digital inputs are those of both.
///
/// `start` runs the drives until they are ready, at most kMaxStart, while the robot stands.
class DrivenPlant final : public Simulator {
 public:
  static constexpr std::int64_t kMaxStart = 10'000'000'000;  ///< ns

  /// `period` is in s. `devices` are at the other end of the driver's line. Throws DriverError as MujocoPlant
  /// does, and for a plant whose drives are not those of torque.
  DrivenPlant(const MachineModel& robot, const MujocoPlantParameters& plant, double period,
              std::unique_ptr<DeviceFront> devices, std::unique_ptr<Driver> driver);

  void start() override;
  void reset() noexcept override { driver_->reset(); }
  void read(SensorFrame& sensors) noexcept override;
  void write(std::span<const JointCommand> commands) noexcept override;
  void stop() noexcept override;
  bool accepts(JointMode mode) const noexcept override { return driver_->accepts(mode); }
  bool measures(MachineInput input) const noexcept override {
    const bool of_drives = input == MachineInput::kJointMotion || input == MachineInput::kJointEffort;
    return of_drives ? driver_->measures(input) : plant_.measures(input);
  }
  void truth(TruthFrame& truth) noexcept override { plant_.truth(truth); }
  void inject(const InjectedFaults& faults) noexcept override { plant_.inject(faults); }
  std::uint64_t scan_cycles() const noexcept override { return plant_.scan_cycles(); }
  LaserScan scan(const TruthFrame& truth) override { return plant_.scan(truth); }
  std::string inject_device(std::string_view component, std::string_view kind) override {
    return devices_->inject(component, kind);
  }
  std::string_view fault_message() const noexcept override { return plant_.fault_message(); }
  std::string description() const override { return driver_->description(); }
  std::string warning() const override;

 private:
  void run_devices() noexcept;
  void pass_imu(SensorFrame& sensors) noexcept;
  /// Lets running drives find that the joints were moved, before the start that ends their faults.
  void find_joints(std::span<const JointCommand> brakes) noexcept;

  MujocoPlant plant_;
  std::unique_ptr<DeviceFront> devices_;
  std::unique_ptr<Driver> driver_;
  TruthFrame truth_;
  SensorFrame wheels_;             // as the driver reports them
  std::vector<JointSample> seen_;  // joints as the devices see them
  std::vector<double> turned_;     // rad, by which a motor is ahead of its joint since a reset
  std::vector<JointCommand> torques_;
};

/// A DeviceSimulator is a simulated robot whose drives another program commands over a line, on the wall clock. To that
/// program it is a robot: plant, devices and line take part only through the messages.
///
/// One call of `step` runs one period. Messages that came since the last call are on the line from the beginning of the
/// period on. Those of the devices go out at its end.
class DeviceSimulator {
 public:
  /// `period` is in s. Throws DriverError.
  DeviceSimulator(const MachineModel& robot, const MujocoPlantParameters& plant, double period,
                  std::unique_ptr<DeviceFront> devices);

  void step() noexcept;

  /// Any thread: the true state at the end of the last step. False, and `out` is as before, if steps disturbed it.
  bool truth(TruthFrame& out) const noexcept { return published_truth_.load(out); }

  /// As DeviceFront::inject.
  std::string inject(std::string_view component, std::string_view kind) { return devices_->inject(component, kind); }

 private:
  MujocoPlant plant_;
  std::unique_ptr<DeviceFront> devices_;
  TruthFrame truth_;
  SensorFrame sensors_;
  LatestValue<TruthFrame> published_truth_;
  std::vector<JointCommand> torques_;
};

/// `brakes` are those of the robot's kind (robots/robot.h). Throws DriverError, and ParameterError with all problems of
/// the drive file.
std::unique_ptr<Driver> make_simulated_machine(const Parameters& parameters, const MachineModel& machine,
                                               const std::vector<Brake>& brakes);

/// Returns the simulated robot for a driver in another program, which finds it at the address of the drive file. Throws
/// as make_simulated_machine.
std::unique_ptr<DeviceSimulator> make_device_simulator(const Parameters& parameters, const MachineModel& machine,
                                                       const std::vector<Brake>& brakes);

}  // namespace robot_control
