#pragma once
/// The quadruped: a robot on four legs, composed of the legged laws.
///
///   recognised by   four legs (machine/legs/leg_model.h)
///   laws            estimation/legged, control/legged, safety/conditions/legged
///   stop profiles   by LegStop. The legs fold: every joint moves to the lying posture within kFoldTime, in a walk
///                   kWalkingFoldTime, since a foot stays behind while the body moves on. It is kFoldStiffness times as
///                   stiff as while it stands, since no feed-forward carries the body. Then it damps, and the drives
///                   brake kBrakeTime after the first order: the robot lies. A foot in the air waits for the others
///   ramp            the robot lies down
///
/// The times of the fold are those of legs of 0.426 m. Times and gains follow leg length and mass as in
/// control/legged. Without its IMU a robot on legs is stopped (imu_lost, imu_stuck and imu_jump always brake).
/// Its feet need not carry it, because it may lie (lift is off).

#include "configuration/parameters.h"
#include "machine/legs/leg_model.h"
#include "robots/robot.h"
#include "signals/robot_kinds.h"

namespace robot_control {

inline constexpr double kMinWalkingRate = 100;  ///< Hz of robot.rate (docs/evidence/legs.md)

class Quadruped : public Robot {
 public:
  static constexpr double kFoldTime = 1.25;        ///< s
  static constexpr double kWalkingFoldTime = 0.2;  ///< s
  static constexpr double kBrakeTime = 1.5;        ///< s
  static constexpr double kFoldStiffness = 3;      ///< as damping its root
  static constexpr double kHoldSpeed = 0.03;       ///< rad/s, below which the brake of a drive holds its joint

  Quadruped(const Parameters& parameters, const LegModel& machine);

  const LegModel& machine() const noexcept override { return machine_; }
  std::string_view kind() const noexcept override { return kLeggedKind; }
  void require_drivable() const override;
  std::uint64_t executable() const noexcept override;
  std::unique_ptr<EstimatorLaw> make_estimator() const override;
  std::unique_ptr<ControllerLaw> make_controller() const override;
  std::unique_ptr<MonitorLaw> make_monitor() const override;
  MachineNeeds needs() const override;
  std::vector<Brake> brakes() const override;
  GateParameters gate() const override;

 private:
  SafetyParameters limits() const;

  Parameters parameters_;
  LegModel machine_;
};

}  // namespace robot_control
