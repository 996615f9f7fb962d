#pragma once
/// The differential drive: a robot on wheels, skid steers among them, composed of the wheeled laws.
///
///   recognised by   drive wheels on both sides (machine/wheeled/drive_train.h)
///   laws            estimation/wheeled/estimator.h, control/wheeled/drive_controller.h, safety/monitor.h
///   stop profiles   one: its drive wheels stop by robot.fail_action, and every other joint brakes

#include "configuration/parameters.h"
#include "machine/wheeled/drive_train.h"
#include "robots/robot.h"
#include "signals/robot_kinds.h"

namespace robot_control {

class DifferentialDrive final : public Robot {
 public:
  DifferentialDrive(const Parameters& parameters, const DriveTrain& machine);

  const DriveTrain& machine() const noexcept override { return machine_; }
  std::string_view kind() const noexcept override { return kWheeledKind; }
  void require_drivable() const override;
  std::uint64_t executable() const noexcept override;
  std::unique_ptr<EstimatorLaw> make_estimator() const override;
  std::unique_ptr<ControllerLaw> make_controller() const override;
  std::unique_ptr<MonitorLaw> make_monitor() const override;
  MachineNeeds needs() const override;
  std::vector<std::string> rate_notes(Role role) const override;
  std::vector<Brake> brakes() const override;
  GateParameters gate() const override;
  std::unique_ptr<Retuner> make_retuner(LatestValue<LiveTuning>& inbox) const override;

 private:
  Parameters parameters_;
  DriveTrain machine_;
};

}  // namespace robot_control
