/// One side of a CAN bus as a filter of lines, for exchanges with programs that are not of this project.
///
///   can_peer drives FILE RATE JOINT…        the drives of a drive file, one cycle per line:
///       TIME ENABLED RESET TORQUE FRAME…    → FRAME… | position velocity effort of the first joint | words; of each
///   can_peer odrive NODE FIRMWARE           a simulated axis with a free motor
///   can_peer cia402 NODE                    a simulated drive with a free motor
///       TIME FRAME…                         → FRAME… | motor's position velocity torque |
///
/// TIME is in ns and does not fall. A FRAME is ID#DATA, or ID#R for a remote request; ID is decimal, DATA hexadecimal.

#include <cstdlib>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "drivers/cia402/cia402_device.h"
#include "drivers/drive/can_drive_file.h"
#include "drivers/odrive/odrive_device.h"
#include "drivers/table/read_drive_file.h"

namespace robot_control {
namespace {

can_frame frame_from(const std::string& text) {
  const std::size_t hash = text.find('#');
  can_frame frame{};
  frame.can_id = static_cast<canid_t>(std::stoul(text.substr(0, hash)));
  const std::string data = text.substr(hash + 1);
  if (data == "R") {
    frame.can_id |= CAN_RTR_FLAG;
    return frame;
  }
  frame.len = static_cast<std::uint8_t>(data.size() / 2);
  for (std::size_t i = 0; i < frame.len; ++i) {
    frame.data[i] = static_cast<std::uint8_t>(std::stoul(data.substr(2 * i, 2), nullptr, 16));
  }
  return frame;
}

void print(const can_frame& frame) {
  std::printf("%u#", frame.can_id & CAN_SFF_MASK);
  if (is_remote_request(frame)) std::printf("R");
  for (unsigned i = 0; i < frame.len && !is_remote_request(frame); ++i) std::printf("%02x", frame.data[i]);
  std::printf(" ");
}

void run_drives(const std::string& file, double rate, const std::vector<std::string>& joints) {
  const auto read = read_drive_file(file, "can", {.joints = joints, .rate = rate});
  DriveSet drives = dynamic_cast<CanDriveFile&>(*read).drives();
  FrameBatch send;
  for (std::string text; std::getline(std::cin, text);) {
    std::istringstream line(text);
    std::int64_t now_ns = 0;
    DriveCommand command;
    line >> now_ns >> command.enabled >> command.reset >> command.torque;
    for (std::string frame; line >> frame;) drives.receive(frame_from(frame), now_ns);
    send.clear();
    drives.step(std::vector(drives.size(), command), now_ns, {&send, 1});
    for (const can_frame& frame : send.frames()) print(frame);
    const JointSample& joint = drives[0].sample().joint;
    std::printf("| %.9g %.9g %.9g | ", joint.position, joint.velocity, joint.effort);
    for (std::size_t i = 0; i < drives.size(); ++i) std::printf("%s%s", i == 0 ? "" : "; ", drives[i].words().c_str());
    std::printf("\n");
    std::fflush(stdout);
  }
}

std::unique_ptr<Device> device_of(const std::vector<std::string>& arguments, VirtualCan& bus, DeviceMotor& motor) {
  const auto node = static_cast<std::uint8_t>(std::stoul(arguments.at(1)));
  if (arguments[0] == "cia402") {
    return std::make_unique<Cia402Device>(Cia402DeviceParameters{.node = node}, bus, std::vector{&motor});
  }
  OdriveDeviceParameters parameters{.node = node, .estimates_period = 0.01};
  parameters.firmware = arguments.at(2) == "0.5" ? odrive::Firmware::k05 : odrive::Firmware::k06;
  return std::make_unique<OdriveDevice>(parameters, bus, motor);
}

void run_device(const std::vector<std::string>& arguments) {
  constexpr std::int64_t kStepNs = 125'000;
  constexpr double kInertia = 0.01;  // kg·m²
  VirtualCan bus(1.0e6);
  DeviceMotor motor;
  const auto device = device_of(arguments, bus, motor);
  const std::size_t peer = bus.join([](const can_frame& frame, std::int64_t) { print(frame); });
  for (std::string text; std::getline(std::cin, text);) {
    std::istringstream line(text);
    std::int64_t until_ns = 0;
    line >> until_ns;
    for (std::string frame; line >> frame;) bus.send(peer, frame_from(frame));
    while (bus.now_ns() < until_ns) {
      const std::int64_t now_ns = std::min(until_ns, bus.now_ns() + kStepNs);
      motor.velocity += motor.torque / kInertia * 1.0e-9 * static_cast<double>(now_ns - bus.now_ns());
      motor.position += motor.velocity * 1.0e-9 * static_cast<double>(now_ns - bus.now_ns());
      bus.advance(now_ns);
      device->step(now_ns);
    }
    std::printf("| %.9g %.9g %.9g | \n", motor.position, motor.velocity, motor.torque);
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace robot_control

int main(int count, char** values) {
  const std::vector<std::string> arguments(values + 1, values + count);
  try {
    if (arguments.at(0) == "drives") {
      robot_control::run_drives(arguments.at(1), std::stod(arguments.at(2)), {arguments.begin() + 3, arguments.end()});
    } else {
      robot_control::run_device(arguments);
    }
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
