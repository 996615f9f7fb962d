#include "drivers/cia402/cia402_device.h"
#include "drivers/cia402/cia402_parameters.h"
#include "drivers/drive/can_front.h"

namespace robot_control {
namespace {

using namespace cia402;  // NOLINT(google-build-using-namespace): the parameters of this device

Cia402DeviceParameters device_of(const Cia402Parameters& drive, const Brake& brake, double clock_ppm) {
  Cia402DeviceParameters device;
  device.node = static_cast<std::uint8_t>(drive.drive.node);
  device.fixed_mapping = drive.pdos == PdoSource::kFixed;
  device.rated_torque = drive.rated_torque != 0 ? drive.rated_torque : drive.drive.torque_limit / drive.drive.gear;
  if (drive.counts_per_turn != 0) device.counts_per_turn = drive.counts_per_turn;
  if (drive.velocity_unit != 0) device.velocity_unit = drive.velocity_unit;
  if (drive.vendor != 0) device.vendor = static_cast<std::uint32_t>(drive.vendor);
  if (drive.product != 0) device.product = static_cast<std::uint32_t>(drive.product);
  device.brake_damping = motor_damping(drive.drive, brake);
  device.brake_stiffness = brake.stiffness / (drive.drive.gear * drive.drive.gear);
  device.brake_hold_speed = brake.hold_speed * drive.drive.gear;
  if (drive.drive.takes_speeds) device.supported_modes = Cia402DeviceParameters::kSpeedModes;
  device.clock_ppm = clock_ppm;
  return device;
}

}  // namespace

std::unique_ptr<DeviceFront> make_cia402_front(const DriveFile& file, FrontSetup setup) {
  return one_device_per_node<Cia402Parameters>(file, std::move(setup),
                                               [](const Cia402Parameters& joint, const Brake& brake, double clock_ppm,
                                                  VirtualCan& bus, const std::vector<DeviceMotor*>& motors) {
                                                 return std::make_unique<Cia402Device>(
                                                     device_of(joint, brake, clock_ppm), bus, motors);
                                               });
}

}  // namespace robot_control
