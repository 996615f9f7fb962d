/// Quadbot as a simulated Go2 that walks behind unitree_bridge on the wall clock. At a moment of its stride the bridge
/// gets a signal. Loop and simulated robot are in this process; what lies between driver and robot are two bridges and
/// DDS.
///
///   go_walk DRIVER_FILE ROBOT_FILE BRIDGE SIGNAL WALK AFTER
///
/// BRIDGE is the process of the driver's bridge. The robot walks for WALK s, and the request goes on for AFTER s. The
/// output is one object of JSON:
///
///   named           s from the signal until driver_fault latched
///   stopped         causes of a stop before the signal
///   before          causes before driver_fault
///   words           of the driver
///   tilt            rad, the greatest one since the signal
///   height, speed   m, m/s, at the end

#include <csignal>
#include <iomanip>
#include <iostream>
#include <string>

#include "drivers/drive_motors.h"
#include "drivers/table/read_drive_file.h"
#include "drivers/table/simulated_front.h"
#include "robots/quadruped_fixture.h"
#include "rt/clock.h"
#include "rt/realtime_thread.h"
#include "simulation/machines/simulated_machine.h"

namespace robot_control {
namespace {

constexpr double kRate = 500;      // Hz
constexpr double kSpeed = 0.5;     // m/s
constexpr double kRest = 1;        // s before the robot stands up
constexpr double kNever = 1e9;     // s
constexpr double kMeanTime = 0.3;  // s, of the speed at the end

/// Lets each period last as long on the wall clock.
class Pace {
 public:
  void wait() {
    next_ns_ = std::max(next_ns_ + kPeriodNs, monotonic_ns() - kPeriodNs);
    sleep_until(next_ns_);
  }
  bool starts = true;  ///< The machine starts, in which its devices wait.

 private:
  static constexpr std::int64_t kPeriodNs = 2'000'000;

  std::int64_t next_ns_ = 0;
};

/// Devices that keep the pace while the machine starts.
class PacedFront final : public DeviceFront {
 public:
  PacedFront(std::unique_ptr<DeviceFront> devices, Pace& pace) : devices_(std::move(devices)), pace_(pace) {}

  std::size_t size() const override { return devices_->size(); }
  bool is_absolute() const override { return devices_->is_absolute(); }
  std::int64_t now_ns() const override { return devices_->now_ns(); }
  LineEnd driver_end() override { return devices_->driver_end(); }
  bool reports_imu() const override { return devices_->reports_imu(); }
  void sense(const ImuSample& imu) override { devices_->sense(imu); }
  void run(std::span<const JointSample> joints) override {
    devices_->run(joints);
    if (pace_.starts) pace_.wait();
  }
  double torque(std::size_t joint) const override { return devices_->torque(joint); }
  std::string inject(std::string_view component, std::string_view kind) override {
    return devices_->inject(component, kind);
  }

 private:
  std::unique_ptr<DeviceFront> devices_;
  Pace& pace_;
};

std::string quoted(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  return quoted + "\"";
}

std::unique_ptr<Driver> machine_of(const Parameters& parameters, const std::string& robot_file, const LegModel& robot,
                                   const std::vector<Brake>& brakes, Pace& pace) {
  const DriveMotors motors = drive_motors(robot, brakes);
  const auto file = read_drive_file(parameters, motors.joints);
  Parameters of_robot = parameters;
  of_robot.drives = robot_file;
  const auto far_file = read_drive_file(of_robot, motors.joints);
  auto devices = std::make_unique<PacedFront>(
      make_front(*far_file, {.motors = motors, .line = open_devices_end(*far_file)}), pace);
  auto driver = file->make_driver(motors, file->open_line(RealtimePolicy::kOff, {}),
                                  [] { return CanTime{.time_ns = monotonic_ns()}; });
  return std::make_unique<DrivenPlant>(robot, parameters.plant, parameters.loop.period(), std::move(devices),
                                       std::move(driver));
}

/// One walk.
class Walk {
 public:
  Walk(const Parameters& parameters, std::shared_ptr<const Robot> robot, std::unique_ptr<Driver> machine, Pace& pace)
      : loop_(parameters, std::move(robot), std::move(machine)), pace_(pace), walks_(walk(kSpeed)) {
    pace_.starts = false;
  }

  /// Runs for `seconds`, and requests to walk if `walks` is true.
  void run(double seconds, bool walks) {
    for (int k = 0; k < seconds * kRate; ++k) {
      if (walks && k % 10 == 0) loop_.request(walks_);
      loop_.step();
      const TruthFrame& truth = loop_.row().driver->truth;
      const Quaternion& q = truth.pose_world.orientation;
      tilt_ = std::max(tilt_, 2 * std::asin(std::min(1.0, std::hypot(q[0], q[1]))));
      const std::uint64_t causes = loop_.row().monitor->permit.causes;
      if (named_ns_ == 0 && (causes & kCauseDriverFault) != 0) named_ns_ = monotonic_ns();
      if (named_ns_ == 0) before_ |= causes;
      pace_.wait();
    }
  }
  void begin_loss() {
    at_loss_ = causes();
    tilt_ = 0;
  }
  std::uint64_t causes() const { return loop_.row().monitor->permit.causes; }
  const Vector3& place() const { return loop_.row().driver->truth.pose_world.position; }

  void print(std::int64_t loss_ns, double speed) const {
    const double named = named_ns_ == 0 ? kNever : 1e-9 * static_cast<double>(named_ns_ - loss_ns);
    std::cout << std::setprecision(6) << "{\"named\": " << named
              << ", \"stopped\": " << quoted(names_of(kStopCauseNames, at_loss_))
              << ", \"before\": " << quoted(names_of(kStopCauseNames, before_))
              << ", \"words\": " << quoted(loop_.warning()) << ", \"tilt\": " << tilt_ << ", \"height\": " << place()[2]
              << ", \"speed\": " << speed << "}" << std::endl;
  }

 private:
  ClosedLoop loop_;
  Pace& pace_;
  Request walks_;
  std::int64_t named_ns_ = 0;  // when driver_fault latched
  std::uint64_t at_loss_ = 0;  // causes
  std::uint64_t before_ = 0;   // causes before driver_fault
  double tilt_ = 0;            // rad, since the loss
};

void run(const std::vector<std::string>& given) {
  Parameters parameters = QuadrupedLoop::parameters(0, ErrorLevel::kDataSheet);
  parameters.loop.rate = kRate;
  parameters.drives = given[0];
  const std::vector<Word> words = words_of(DriverName());
  parameters.driver = static_cast<DriverName>(std::ranges::find(words, "unitree_go", &Word::text)->value);
  const LegModel robot = legged_robot("quadbot");
  const auto kind = std::make_shared<Quadruped>(parameters, robot);
  precede_ordinary_threads();
  Pace pace;
  Walk trial(parameters, kind, machine_of(parameters, given[1], robot, kind->brakes(), pace), pace);
  trial.run(kRest, false);
  trial.run(std::stod(given[4]), true);
  trial.begin_loss();
  const std::int64_t loss_ns = monotonic_ns();
  if (kill(std::stoi(given[2]), std::stoi(given[3])) != 0) throw std::runtime_error("there is no bridge " + given[2]);
  trial.run(std::stod(given[5]) - kMeanTime, true);
  const Vector3 from = trial.place();
  trial.run(kMeanTime, true);
  const Vector3& to = trial.place();
  trial.print(loss_ns, std::hypot(to[0] - from[0], to[1] - from[1]) / kMeanTime);
}

}  // namespace
}  // namespace robot_control

int main(int argc, char** argv) {
  if (argc != 7) {
    std::cerr << "go_walk DRIVER_FILE ROBOT_FILE BRIDGE SIGNAL WALK AFTER\n";
    return 2;
  }
  try {
    robot_control::run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
