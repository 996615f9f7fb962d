/// bench_board_clock measures how far the driver's time of a sample is from the truth. The line before the motor board
/// has 3 ms of jitter, and the board's clock runs fast by 200 ppm. A wheel turns steadily, so that the error of its
/// position at the time of `read` by its speed is the error of the time. It contains the resolution of the encoder.

#include <cmath>
#include <iostream>
#include <vector>

#include "bench/programs/rows.h"
#include "drivers/board/board_machine.h"

namespace robot_control::bench {

constexpr double kSpeed = 10;    // rad/s
constexpr double kSettled = 5;   // s, until drift and offset are known
constexpr double kSeconds = 60;  // s
constexpr double kAllowed = 100;

Row error_at(double rate) {
  BoardMachine machine(rate);
  machine.start();
  if (!machine.board().inject("line", "late").empty()) throw std::runtime_error("no such fault of the line");
  SensorFrame sensors;
  const std::vector<JointCommand> commands(2, {.mode = JointMode::kVelocity, .velocity = kSpeed, .damping = 0.2});
  std::vector<double> errors_us;
  for (int cycle = 0; cycle < static_cast<int>(kSeconds * rate); ++cycle) {
    machine.read(sensors);
    const JointSample& truth = machine.joints[0];
    const double error_us = 1.0e6 * std::abs((sensors.joints[0].position - truth.position) / truth.velocity);
    if (cycle >= static_cast<int>(kSettled * rate)) errors_us.push_back(error_us);
    machine.write(commands);
  }
  if (sensors.driver_state != DriverState::kRunning) throw std::runtime_error(machine.warning());
  const double value = median(errors_us);
  return {"time of a sample at " + std::to_string(static_cast<int>(rate)) + " Hz, median of the error",
          value,
          "us",
          kAllowed,
          "what is allowed",
          value / kAllowed};
}

}  // namespace robot_control::bench

int main() {
  using namespace robot_control::bench;
  try {
    std::vector<Row> rows;
    for (const double rate : {50.0, 100.0, 250.0, 500.0, 1000.0}) rows.push_back(error_at(rate));
    print("board_clock", rows);
  } catch (const std::exception& error) {
    std::cerr << "bench_board_clock: " << error.what() << "\n";
    return 1;
  }
  return 0;
}
