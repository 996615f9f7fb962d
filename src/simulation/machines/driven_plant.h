#pragma once
/// A DrivenPlant is the simulated robot behind motor drives on CAN, in virtual time. The driver of the drives computes
/// torques and frames, the bus carries them, the devices turn the motors of the MuJoCo plant. The driver does not know
/// that they are simulated.
///
/// In each period the devices see the wheels move on with the velocity of its beginning. The plant applies the mean
/// torque of a device over the period. IMU, contacts, battery and the other joints are those of the plant.
///
/// `start` runs the drives until they are ready, at most kMaxStart, while the robot stands.

#include <memory>

#include "drivers/can/can_driver.h"
#include "drivers/mujoco/mujoco_plant.h"
#include "simulation/devices/simulated_drives.h"

namespace robot_control {

class DrivenPlant final : public Simulator {
 public:
  static constexpr std::int64_t kMaxStart = 10'000'000'000;  ///< ns

  /// `period` is in s. Throws DriverError as MujocoPlant does.
  DrivenPlant(const DriveTrain& robot, const MujocoPlantParameters& plant, const CanParameters& can, double period);
  ~DrivenPlant() override;
  DrivenPlant(const DrivenPlant&) = delete;
  DrivenPlant& operator=(const DrivenPlant&) = delete;

  void start() override;
  void reset() noexcept override { driver_->reset(); }
  void read(SensorFrame& sensors) noexcept override;
  void write(std::span<const JointCommand> commands) noexcept override;
  void stop() noexcept override;
  bool implements(StopKind kind) const noexcept override { return driver_->implements(kind); }
  void truth(TruthFrame& truth) noexcept override { plant_.truth(truth); }
  void inject(const InjectedFaults& faults) noexcept override { plant_.inject(faults); }
  std::string inject_device(std::string_view component, std::string_view kind) override;
  std::string_view fault_message() const noexcept override { return plant_.fault_message(); }
  std::string warning() const override;

  const CanDriver& driver() const noexcept { return *driver_; }

 private:
  void run_drives() noexcept;
  void deliver() noexcept;

  MujocoPlant plant_;
  SimulatedDrives drives_;
  std::unique_ptr<CanDriver> driver_;
  std::int64_t period_ns_;
  std::size_t party_ = 0;             // of the driver on the bus
  std::vector<can_frame> to_driver_;  // of the present period
  int wire_ = -1;                     // the end of the socket that is not the driver's
  TruthFrame truth_;
  std::vector<std::string> joints_;  // of the drives
  SensorFrame wheels_;               // as the driver reports them
  std::vector<JointCommand> torques_;
};

}  // namespace robot_control
