#pragma once
/// A CanFront is the simulated drives of a drive file on its CAN buses in virtual time. Each is set up as its drive
/// file expects it. Their clocks run fast and slow by kClockPpm in turn.
///
/// `inject` takes a joint, the address of a bus, or `bus` for all of them as the component. The kinds of a bus are ok,
/// off, lossy, disturbed and second_writer. Off means that the driver's cable is out, lossy that frames are lost with
/// the probability kFrameLoss. On a disturbed bus the others are late as well, by up to one period. A second writer
/// sends each of the driver's frames as well. With a word of AnswerFault this happens to the frames to the driver. A
/// fault of a drive with two axes belongs to both.

#include <algorithm>
#include <deque>
#include <map>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "drivers/drive/can_drive_file.h"
#include "drivers/drive/device.h"
#include "drivers/drive/device_front.h"
#include "drivers/line/answer_faults.h"
#include "drivers/line/can_bus.h"

namespace robot_control {

class CanFront final : public DeviceFront {
 public:
  /// ns between two steps of a device; frames arrive at their own times.
  static constexpr std::int64_t kStepNs = 250'000;

  static constexpr double kClockPpm = 200;
  static constexpr double kFrameLoss = 0.05;  ///< of a lossy bus

  /// Without devices. `setup.line` holds the ends of the lines that are not the driver's.
  CanFront(const CanDriveFile& file, FrontSetup setup);
  CanFront(const CanFront&) = delete;
  CanFront& operator=(const CanFront&) = delete;

  /// Adds the motor of the next joint.
  DeviceMotor& add_motor(const DriveParameters& joint);
  /// Adds a device that turns the motors of these joints. Its clock runs fast by `next_clock_ppm`.
  void add_device(std::unique_ptr<Device> device, std::span<const std::size_t> joints);
  double next_clock_ppm() const noexcept { return devices_.size() % 2 == 0 ? kClockPpm : -kClockPpm; }
  /// Returns the bus with this address.
  VirtualCan& bus(const std::string& address);

  std::size_t size() const override { return motors_.size(); }
  bool is_absolute() const override { return is_absolute_; }
  std::int64_t now_ns() const override { return buses_.front().can.now_ns(); }
  LineEnd driver_end() override { return std::move(driver_ends_); }
  void run(std::span<const JointSample> joints) override;
  double torque(std::size_t joint) const override { return torques_.at(joint); }
  std::string inject(std::string_view component, std::string_view kind) override;

 private:
  struct Answer {
    can_frame frame{};
    std::int64_t due_ns = 0;
  };

  /// A bus with the devices' end of its line.
  struct Bus {
    Bus(const CanDriveFile& file, std::string bus_address, CanSocket socket, std::uint64_t seed);
    void carry(can_frame frame, std::int64_t now_ns);
    void inject(std::string_view kind, std::int64_t period_ns);

    std::string address;
    VirtualCan can;
    CanBus line;
    std::size_t host;            // the driver's party on the simulated bus
    std::deque<Answer> answers;  // on their way to the driver
    AnswerFault fault = AnswerFault::kNone;
    bool has_second_writer = false;
    std::mt19937_64 random;
  };

  void run_devices(std::span<const JointSample> joints);

  CanSockets driver_ends_;  // of lines in virtual time
  std::deque<Bus> buses_;   // A Bus does not move.
  std::int64_t period_ns_;
  std::vector<std::string> joints_;
  bool is_absolute_ = false;

  std::vector<double> to_motor_;  // motor angle / joint angle
  std::vector<std::unique_ptr<DeviceMotor>> motors_;
  std::vector<std::unique_ptr<Device>> devices_;
  std::vector<std::size_t> device_of_;  // each joint
  std::vector<double> torques_;         // N·m, of the joints, mean over the last period
};

/// Returns the gain of a motor's speed loop: the damping of the brake, which is stable also for a lifted wheel.
inline double motor_damping(const DriveParameters& drive, const Brake& brake) {
  return brake.damping / (drive.gear * drive.gear);
}

/// Returns the front of a drive file with one device per node, of device_of(joint, brake, clock_ppm). `joint` and
/// `brake` are those of the node's first axis. A device turns one motor, or all motors of its node.
template <class Device, class Parameters, class Of>
std::unique_ptr<DeviceFront> one_device_per_node(const DriveFile& file, FrontSetup setup,
                                                 Of (*device_of)(const Parameters&, const Brake&, double)) {
  const auto& drives = dynamic_cast<const CanFileOf<Parameters>&>(file);
  const std::vector<Parameters>& joints = drives.joints();
  const std::vector<Brake>& brakes = setup.motors.brakes;
  auto front = std::make_unique<CanFront>(drives, std::move(setup));
  std::vector<DeviceMotor*> motors;
  std::map<std::pair<std::string, std::uint64_t>, std::map<decltype(joints[0].place()), std::size_t>> nodes;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    motors.push_back(&front->add_motor(joints[i].drive));
    nodes[{joints[i].drive.bus, joints[i].drive.node}][joints[i].place()] = i;
  }
  for (const auto& [node, axes] : nodes) {
    std::vector<std::size_t> of_node;
    std::vector<DeviceMotor*> its_motors;
    for (const auto& [place, joint] : axes) {
      of_node.push_back(joint);
      its_motors.push_back(motors[joint]);
    }
    const std::size_t first = of_node.front();
    VirtualCan& bus = front->bus(node.first);
    const Of device = device_of(joints[first], brakes[first], front->next_clock_ppm());
    if constexpr (std::is_constructible_v<Device, Of, VirtualCan&, DeviceMotor&>) {
      front->add_device(std::make_unique<Device>(device, bus, *its_motors.front()), of_node);
    } else {
      front->add_device(std::make_unique<Device>(device, bus, its_motors), of_node);
    }
  }
  return front;
}

}  // namespace robot_control
