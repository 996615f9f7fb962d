#pragma once
/// A CanDriveFile is the drive file of drives on CAN: a block `bus`, and one block per joint. A robot with more than
/// one bus names the address of a joint's bus beside its node. `bus.address` is that of the other joints, and all buses
/// have `bus.bit_rate`.

#include <string>
#include <vector>

#include "drivers/drive/drive_file.h"
#include "drivers/drive/drive_set.h"
#include "drivers/drive_parameters.h"
#include "drivers/line/can_load.h"
#include "parameters/block.h"

namespace robot_control {

/// A row of drive_table.def whose driver is `can`, in the order of the table.
enum class CanDialect : std::uint8_t {};

inline std::vector<Word> words_of(CanDialect) {
  std::vector<Word> words;
  const auto add = [&](std::string_view name, std::string_view driver) {
    if (driver == "can") words.emplace_back(name, static_cast<CanDialect>(words.size()));
  };
#define DRIVE(name, driver, ...) add(#name, #driver);
#include "drivers/drive_table.def"
  return words;
}

struct CanBusParameters {
  CanDialect dialect{};
  std::string address = "can0";   ///< can_socket.h
  double bit_rate = 1.0e6;        ///< bit/s, as set on the interface
  double data_rate = 0;           ///< bit/s of the data of CAN FD, likewise; 0: classic CAN
  std::uint64_t host_node = 127;  ///< of this program, for the heartbeat that CANopen drives expect
};

inline Keys keys(CanBusParameters& bus) {
  return {
      {"dialect", &bus.dialect},
      {"address", &bus.address, {}, 0, 0, kOptional},
      {"bit_rate", &bus.bit_rate, "bit/s", 10000, 1.0e6, kOptional},
      {"host_node", &bus.host_node, {}, 1, 127, kOptional},
  };
}

class CanDriveFile : public DriveFile {
 public:
  using DriveFile::DriveFile;

  std::string_view line_block() const override { return "bus"; }
  Keys line_keys() override { return keys(bus); }
  std::optional<Overload> overload() override;
  const std::string& address() const override { return bus.address; }
  LineEnd open_line(RealtimePolicy /*policy*/, const DriverClock& /*clock*/) const override { return open_buses(); }
  std::unique_ptr<Driver> make_driver(const DriveMotors& motors, LineEnd line, DriverClock clock) const override;

  /// Returns the drives of all joints.
  virtual DriveSet drives() const = 0;

  /// Opens the buses in the order of DriveSet::buses. Throws DriverError.
  CanSockets open_buses() const;

  /// Returns the part of the bit rate that the planned frames may need.
  virtual double max_load() const { return kMaxBusLoad; }

  CanBusParameters bus;

 protected:
  /// Leaves out the frames that the drives can do without.
  virtual void leave_out_frames() {}
};

/// The drive file of drives of one dialect.
template <class Parameters>
class CanFileOf : public FileOfJoints<CanDriveFile, Parameters> {
 public:
  explicit CanFileOf(DriveFileRequest request) : FileOfJoints<CanDriveFile, Parameters>(std::move(request)) {
    this->every_.drive.takes_speeds = this->request().takes_speeds;
  }

  Keys every_keys() override {
    this->every_.drive.bus = this->bus.address;
    return FileOfJoints<CanDriveFile, Parameters>::every_keys();
  }

 private:
  bool same_line(const Parameters& joint, const Parameters& other) const override {
    return joint.drive.bus == other.drive.bus;
  }
};

}  // namespace robot_control
