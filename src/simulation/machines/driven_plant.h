#pragma once
/// A DrivenPlant is the simulated robot behind motor drives, in virtual time. The driver of the drives computes torques
/// and messages, the line carries them, the devices turn the motors of the MuJoCo plant. The driver does not know that
/// they are simulated.
///
/// In each period the devices see the wheels move on with the velocity of its beginning. The plant applies the mean
/// torque of a device over the period. IMU, contacts, battery and the other joints are those of the plant. Digital
/// inputs are those of both.
///
/// `start` runs the drives until they are ready, at most kMaxStart, while the robot stands.

#include <memory>
#include <vector>

#include "drivers/drive/device_front.h"
#include "drivers/mujoco/mujoco_plant.h"

namespace robot_control {

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

  MujocoPlant plant_;
  std::unique_ptr<DeviceFront> devices_;
  std::unique_ptr<Driver> driver_;
  TruthFrame truth_;
  SensorFrame wheels_;             // as the driver reports them
  std::vector<JointSample> seen_;  // joints as the devices see them
  std::vector<double> turned_;     // rad, by which a motor is ahead of its joint since a reset
  std::vector<JointCommand> torques_;
};

}  // namespace robot_control
