#include "drivers/drive/can_front.h"
#include "drivers/odrive/odrive_device.h"
#include "drivers/odrive/odrive_parameters.h"

namespace robot_control {
namespace {

using namespace odrive;  // NOLINT(google-build-using-namespace): the messages of this device

constexpr double kOdriveWatchdog = 0.1;  // s, where the drive file says that it coasts on silence

OdriveDeviceParameters device_of(const OdriveParameters& drive, const Brake& brake, double clock_ppm) {
  return {.node = static_cast<std::uint8_t>(drive.drive.node),
          .firmware = drive.firmware == Firmware::k05 ? Firmware::k05 : Firmware::k06,
          .serial_number = drive.serial_number != 0 ? drive.serial_number : 1 + drive.drive.node,
          .torque_constant = drive.torque_constant,
          .counts_per_turn = drive.counts_per_turn,
          .heartbeat_period = drive.heartbeat_period,
          .estimates_period = drive.estimates_period,
          .effort_period = drive.effort_period,
          .watchdog_timeout = drive.drive.on_silence == SilenceReaction::kCoasts ? kOdriveWatchdog : 0,
          .enable_watchdog_endpoint = static_cast<std::uint16_t>(drive.enable_watchdog_endpoint),
          .watchdog_timeout_endpoint = static_cast<std::uint16_t>(drive.watchdog_timeout_endpoint),
          .speed_gain = motor_damping(drive.drive, brake),
          .clock_ppm = clock_ppm};
}

}  // namespace

std::unique_ptr<DeviceFront> make_odrive_front(const DriveFile& file, FrontSetup setup) {
  return one_device_per_node<OdriveParameters>(file, std::move(setup),
                                               [](const OdriveParameters& joint, const Brake& brake, double clock_ppm,
                                                  VirtualCan& bus, const std::vector<DeviceMotor*>& motors) {
                                                 return std::make_unique<OdriveDevice>(
                                                     device_of(joint, brake, clock_ppm), bus, *motors.front());
                                               });
}

}  // namespace robot_control
