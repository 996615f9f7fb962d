#include "drivers/table/simulated_front.h"

#include "drivers/drive/can_drive_file.h"
#include "drivers/drive/datagram_drive_file.h"
#include "drivers/line/pseudo_terminal.h"

namespace robot_control {

std::unique_ptr<DeviceFront> make_front(const DriveFile& file, FrontSetup setup) {
#define DRIVE(name, ...) \
  if (file.request().drive == #name) return make_##name##_front(file, std::move(setup));
#include "drivers/drive_table.def"
  return nullptr;
}

LineEnd open_devices_end(const DriveFile& file) {
  if (const auto* can = dynamic_cast<const CanDriveFile*>(&file)) return can->open_buses();
  if (dynamic_cast<const DatagramDriveFile*>(&file) != nullptr) return UdpSocket::device_end(file.address());
  return std::make_unique<PseudoTerminal>(file.address());
}

}  // namespace robot_control
