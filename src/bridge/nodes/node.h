#pragma once
/// One node around one process: the order of start-up, the ordinary thread, the end.
///
///   ros::init → read_setup → Process (takes the locks) → NodeHandle → topics → ordinary thread
///
/// The node is registered with ROS only after the locks are taken, so a second instance ends without affecting the
/// first. The ordinary thread polls the process at 10 Hz, publishes, and reports missing nodes. Callbacks run in
/// two further threads. Nothing here ever waits on ROS time.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "bridge/startup/setup.h"

namespace ros {
class NodeHandle;
}

namespace robot_control {

class DiagnosticReport;

class Node {
 public:
  virtual ~Node() = default;

  /// The locks are held: now topics and services may appear. Throws what refuses the start.
  virtual void connect(ros::NodeHandle& handle) = 0;

  /// Ordinary thread, at 10 Hz.
  virtual void poll() = 0;

  /// Ordinary thread, every `tick_ns`: publishes what is due.
  virtual void publish() = 0;
  virtual std::int64_t tick_ns() const = 0;

  /// The loop has ended by itself.
  virtual bool finished() const = 0;

  /// The loop ends; what was taken in is put away. Throws what could not be.
  virtual void stop() = 0;

  virtual std::vector<std::string> missing() const = 0;
  virtual std::vector<std::string> realtime_messages() const = 0;

  /// For /diagnostics, at 1 Hz.
  virtual void diagnose(DiagnosticReport& report) = 0;
};

/// Takes the locks; throws BusError and whatever refuses the start.
using MakeNode = std::unique_ptr<Node> (*)(const Setup&);

struct NodeProgram {
  std::string name;     ///< of the node and of its block of parameters
  std::string purpose;  ///< what the node does, in sentences
  MakeNode make;
};

/// The body of main. 0: --help, or ended by SIGINT, SIGTERM, ROS or by itself. 1: refused, reported on stderr.
int run_node(int argc, char** argv, const NodeProgram& program);

/// Publish tick for topics of these rates [Hz], in a loop of this period: a quarter of the shortest interval,
/// 0.25 … 2 ms. In lockstep, where simulated time runs much faster, the shortest.
std::int64_t publish_tick_ns(const Parameters& parameters, std::initializer_list<double> rates);

}  // namespace robot_control
