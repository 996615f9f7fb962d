#include "loop/processes/estimator_process.h"

#include "loop/mint_number.h"

namespace robot_control {

EstimatorProcess::EstimatorProcess(const Parameters& parameters, const Robot& robot, const std::string& bus)
    : ConsumerProcess(parameters, robot, bus,
                      {LoopPriority::kEstimator, "estimator", ChannelNames::kState, TraceRing::kEstimator}),
      cycle_(robot.make_estimator(), robot_.hash, sensors_.reader, output_.writer, clock()) {
  cycle_.set_process(mint_number());
}

}  // namespace robot_control
