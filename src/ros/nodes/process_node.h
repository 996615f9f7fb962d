#pragma once
/// A ProcessNode is a Node that runs a Process; it is the common part of the four nodes of the loop.

#include <string>
#include <utility>
#include <vector>

#include "loop/processes/process.h"
#include "robots/differential_drive.h"
#include "ros/messages/time_map.h"
#include "ros/nodes/node.h"

namespace robot_control {

template <class Work>
class ProcessNode : public Node {
 public:
  /// `more` are the arguments of Work's constructor behind parameters, robot and bus.
  template <class... More>
  explicit ProcessNode(const Setup& setup, More&&... more)
      : setup_(setup),
        time_(setup.parameters.loop.clock),
        composed_(setup.parameters, setup.robot),
        process_(setup.parameters, composed_, setup.bus, std::forward<More>(more)...) {}

  void poll() override { process_.poll(); }
  bool finished() const override { return process_.finished(); }
  void stop() override { process_.stop(); }

  /// Returns the state of the last poll; any thread may call it.
  std::vector<std::string> missing() const override { return process_.last_missing(); }

  std::vector<std::string> realtime_messages() const override { return process_.realtime_messages(); }

 protected:
  const Parameters& parameters() const { return setup_.parameters; }
  const ReportParameters& report() const { return setup_.parameters.report; }
  const DriveTrain& robot() const { return setup_.robot; }
  Work& process() { return process_; }
  TimeMap& time() { return time_; }

 private:
  Setup setup_;
  TimeMap time_;
  DifferentialDrive composed_;
  Work process_;
};

}  // namespace robot_control
