#include "drivers/drive/can_front.h"
#include "drivers/vesc/vesc_device.h"
#include "drivers/vesc/vesc_parameters.h"

namespace robot_control {
namespace {

using vesc::VescParameters;

constexpr double kVescCurrent = 10;  // A

/// Without a torque constant in the file the motor gives its greatest torque at kVescCurrent.
VescDeviceParameters device_of(const VescParameters& drive, const Brake& brake, double clock_ppm) {
  const double torque = drive.drive.torque_limit / drive.drive.gear;
  const double constant = drive.torque_constant > 0 ? drive.torque_constant : torque / kVescCurrent;
  return {.node = static_cast<std::uint8_t>(drive.drive.node),
          .pole_pairs = static_cast<double>(drive.pole_pairs),
          .torque_constant = constant,
          .max_current = torque / constant,
          .status_period = drive.status_period,
          .temperature_period = drive.temperature_period,
          .brake_current = drive.drive.on_silence == SilenceReaction::kBrakes ? torque / constant : 0,
          .speed_gain = motor_damping(drive.drive, brake),
          .clock_ppm = clock_ppm};
}

}  // namespace

std::unique_ptr<DeviceFront> make_vesc_front(const DriveFile& file, FrontSetup setup) {
  return one_device_per_node<VescParameters>(file, std::move(setup),
                                             [](const VescParameters& joint, const Brake& brake, double clock_ppm,
                                                VirtualCan& bus, const std::vector<DeviceMotor*>& motors) {
                                               return std::make_unique<VescDevice>(device_of(joint, brake, clock_ppm),
                                                                                   bus, *motors.front());
                                             });
}

}  // namespace robot_control
