#pragma once
/// A CommandedNode is the controller's node of any kind of robot. It gives the requests of its senders to the loop, by
/// the safety monitor's permission (ros/inputs/command_intake.h). It follows the commands of the loop.

#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "bus/latest_frames.h"
#include "loop/processes/controller_process.h"
#include "ros/inputs/command_input.h"
#include "ros/nodes/process_node.h"
#include "signals/command_frame.h"

namespace robot_control {

/// The reports of any of several commands.
struct CommandReports {
  std::uint64_t reasons = 0;              ///< CommandReason bits
  std::uint64_t risers = 0, reaches = 0;  ///< as in LeggedCommand

  void add(const CommandFrame& command) noexcept {
    reasons |= command.reasons;
    risers |= command.legged.risers;
    reaches |= command.legged.reaches;
  }
};

/// A CommandHistory collects the reports of every cycle for a slower thread.
class CommandHistory {
 public:
  /// Returns the reports of all cycles after that of the last call up to `newest`, as far as the channel still has
  /// them. In a new run it returns those of `newest` alone.
  CommandReports collect(const FrameReader<CommandFrame>& channel, const CommandFrame& newest) noexcept {
    const bool same_run = newest.head.run == run_;
    CommandReports reports;
    reports.add(newest);
    CommandFrame frame;
    for (std::uint64_t back = 1; same_run && back < kFrameSlots && cycle_ + back < newest.head.cycle; ++back) {
      if (channel.at(run_, newest.head.cycle - back, frame) == Lookup::kFrame) reports.add(frame);
    }
    run_ = newest.head.run;
    cycle_ = newest.head.cycle;
    return reports;
  }

 private:
  std::uint64_t run_ = 0;
  std::uint64_t cycle_ = 0;
};

class CommandedNode : public ProcessNode<ControllerProcess> {
 protected:
  /// `intake` is used after the constructor only.
  CommandedNode(const Setup& setup, CommandIntake& intake) : ProcessNode(setup, Role::kController), intake_(&intake) {}

  void use(CommandIntake& intake) { intake_ = &intake; }
  CommandIntake& intake() { return *intake_; }

  /// Returns the situation at the start. It is called before this node subscribes to a topic of requests, and before
  /// its loop runs.
  EarlierController earlier_controller(ros::NodeHandle& handle, const std::vector<std::string>& topics);

  /// Returns the time of a message of `sender` that arrives now. The caller holds input_mutex_, gives the message to
  /// the intake, and calls `store`.
  ArrivalTime arrival_of(const std::string& sender);
  void store() { process().cycle().inbox().store(intake_->value()); }

  /// Returns the stamp of the newest sensor frame. The caller holds input_mutex_.
  std::int64_t loop_ns();

  /// Applies permission and silences to the intake, logs what it reports, and reads the newest command into command_.
  /// Returns false if there is none of this run.
  bool follow_command();

  std::mutex input_mutex_;  ///< protects the intake
  CommandFrame command_;
  CommandReports reports_;           ///< since the last call of follow_command
  std::uint64_t since_message_ = 0;  ///< CommandReason bits since the last message about them
  std::uint64_t since_report_ = 0;   ///< CommandReason bits since the last /diagnostics

 private:
  bool follow_permission();
  void log_dropped(const std::string& sender);
  void look_at_senders();

  CommandIntake* intake_;
  std::int64_t loop_ns_ = 0;
  bool dropped_reported_ = false;
  CommandHistory history_;
};

}  // namespace robot_control
