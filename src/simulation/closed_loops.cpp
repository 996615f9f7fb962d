#include "simulation/closed_loops.h"

#include <cmath>
#include <stdexcept>

namespace robot_control {
namespace {

bool is_message(const Twist& twist) noexcept {
  return std::isfinite(twist.linear[0]) && std::isfinite(twist.linear[1]) && std::isfinite(twist.angular[2]);
}

}  // namespace

ClosedLoops::ClosedLoops(const Parameters& parameters, std::span<const std::uint64_t> seeds, std::size_t threads)
    : parameters_(parameters), pool_(threads), loops_(seeds.size()) {
  if (seeds.empty()) throw std::invalid_argument("there must be at least one loop");
  loops_.front() = made(seeds.front());
  parameters_ = loops_.front()->parameters();
  robot_ = loops_.front()->shared_robot();
  pool_.for_each(seeds.size() - 1, [&](std::size_t i) { loops_[i + 1] = made(seeds[i + 1]); });
}

ClosedLoops::ClosedLoops(const ClosedLoops& other, std::span<const std::size_t> which, std::size_t threads)
    : parameters_(other.parameters_), robot_(other.robot_), pool_(threads), loops_(which.size()) {
  if (which.empty()) throw std::invalid_argument("there must be at least one loop");
  pool_.for_each(which.size(), [&](std::size_t i) { loops_[i] = std::make_shared<ClosedLoop>(*other.loop(which[i])); });
}

std::shared_ptr<ClosedLoop> ClosedLoops::made(std::uint64_t seed) const {
  Parameters parameters = parameters_;
  parameters.plant.seed = seed;
  return std::make_shared<ClosedLoop>(parameters, robot_);
}

void ClosedLoops::reset(std::span<const std::size_t> which, std::span<const std::uint64_t> seeds) {
  if (which.size() != seeds.size()) throw std::invalid_argument("there must be one seed per loop");
  pool_.for_each(which.size(), [&](std::size_t i) { loops_.at(which[i]) = made(seeds[i]); });
}

void ClosedLoops::step(std::uint64_t cycles, std::span<const Twist> commands, std::span<const TraceColumn> columns,
                       std::span<double> out) {
  pool_.for_each(loops_.size(), [&](std::size_t i) {
    ClosedLoop& loop = *loops_[i];
    if (!commands.empty() && is_message(commands[i])) loop.command(commands[i]);
    for (std::uint64_t cycle = 0; cycle < cycles; ++cycle) loop.step();
    auto cell = out.begin() + static_cast<std::ptrdiff_t>(i * columns.size());
    for (const TraceColumn& column : columns) *cell++ = column.value(loop.row(), column.element);
  });
}

}  // namespace robot_control
