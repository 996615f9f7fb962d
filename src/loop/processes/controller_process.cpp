#include "loop/processes/controller_process.h"

#include "loop/mint_number.h"
#include "signals/roles.h"

namespace robot_control {

ControllerProcess::ControllerProcess(const Parameters& parameters, const Robot& robot, const std::string& bus)
    : ConsumerProcess(parameters, robot, bus,
                      {LoopPriority::kController, "controller", ChannelNames::kCommand, TraceRing::kController}),
      state_(bus, ChannelNames::kState),
      permit_(bus, ChannelNames::kPermit),
      cycle_(robot.make_controller(), robot_.hash, {&sensors_.reader, &state_.reader, &permit_.reader, output_.writer},
             load_script(parameters.loop.command_script, robot.executable()), clock()),
      retuner_(robot.make_retuner(cycle_.tunings())) {
  robot.require_drivable();
  cycle_.set_process(mint_number());
}

std::vector<std::string> ControllerProcess::missing() const {
  std::vector<std::string> names = ConsumerProcess::missing();
  if (!state_.channel.locked()) names.emplace_back(program_of(Role::kEstimator));
  if (!permit_.channel.locked()) names.emplace_back(program_of(Role::kMonitor));
  return names;
}

void ControllerProcess::poll_channels() {
  state_.poll();
  permit_.poll();
  ConsumerProcess::poll_channels();
}

bool ControllerProcess::ready() {
  return ConsumerProcess::ready() && state_.reader.memory() != nullptr && permit_.reader.memory() != nullptr;
}

}  // namespace robot_control
