#pragma once
/// The body of main of a program beside the loop: a node with ordinary threads alone.

#include <string>

namespace robot_control {

struct ServiceProgram {
  std::string name;     ///< name of the node
  std::string purpose;  ///< task of the program, in sentences
  void (*spin)();       ///< makes the node and spins until ROS ends; an exception refuses the start
};

/// Listens where ROS is configured to, as the nodes of the loop do. Returns 0 after --help and after an end by a signal
/// or by ROS; returns 1 after a refusal, which is reported on stderr.
int run_service(int argc, char** argv, const ServiceProgram& program);

}  // namespace robot_control
