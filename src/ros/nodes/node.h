#pragma once
/// A Node wraps one process and defines its start-up order, its ordinary thread and its end.
///
///   ros::init → read_setup → Process (takes the locks) → NodeHandle → topics → ordinary thread
///
/// The node is registered with ROS only after the locks are taken, so a second instance ends without affecting the
/// first. The ordinary thread polls the process at 10 Hz, publishes, and reports missing nodes. Callbacks run in two
/// further threads. Nothing here waits on ROS time.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ros/reports/pacer.h"
#include "ros/startup/setup.h"

namespace ros {
class NodeHandle;
}

namespace robot_control {

class DiagnosticReport;

class Node {
 public:
  virtual ~Node() = default;

  /// Returns what the rate of the loop costs, in sentences that are logged at the start.
  virtual std::vector<std::string> rate_notes() const { return {}; }

  /// Creates topics and services; the locks are held by then. An exception refuses the start.
  virtual void connect(ros::NodeHandle& handle) = 0;

  /// Is called by the ordinary thread at 10 Hz.
  virtual void poll() = 0;

  /// Publishes the topics that are due; is called by the ordinary thread every `tick_ns`.
  virtual void publish() = 0;
  virtual std::int64_t tick_ns() const = 0;

  /// Returns whether the loop has ended by itself.
  virtual bool finished() const = 0;

  /// Ends the loop and saves its data. Throws if they could not be saved.
  virtual void stop() = 0;

  virtual std::vector<std::string> missing() const = 0;
  virtual std::vector<std::string> realtime_messages() const = 0;

  /// Fills the node's entry on /diagnostics, at 1 Hz.
  virtual void diagnose(DiagnosticReport& report) = 0;

  /// Adds how punctual the real-time thread of the loop is, if the node has one.
  virtual void diagnose_timing(DiagnosticReport& /*report*/) {}

  /// Returns whether `publish` calls the callbacks of ROS. Otherwise two further threads do.
  virtual bool calls_callbacks() const { return false; }
};

/// Takes the locks. Throws BusError, or another exception that refuses the start.
using MakeNode = std::unique_ptr<Node> (*)(const Setup&);

struct NodeProgram {
  std::string name;     ///< name of the node and of its block of parameters
  std::string purpose;  ///< task of the node, in sentences
  MakeNode make;
  bool in_loop = true;  ///< false: a program beside the loop, without a description of the robot and without a bus
};

/// The body of main. Returns 0 after --help and after an end by SIGINT, SIGTERM, ROS or the node itself; returns 1
/// after a refusal, which is reported on stderr.
int run_node(int argc, char** argv, const NodeProgram& program);

/// Returns the tick of the publishing thread, 0.25 … 10 ms. It ends when the first of these topics is due, counted from
/// the newest frame, whose stamp is `stamp_ns`. For a topic faster than a quarter of the loop's rate it is a quarter of
/// a cycle, so that no frame is missed. In lockstep, where simulated time runs much faster, it is 0.25 ms.
std::int64_t publish_tick_ns(const Parameters& parameters, std::int64_t stamp_ns,
                             std::initializer_list<const Pacer*> topics);

}  // namespace robot_control
