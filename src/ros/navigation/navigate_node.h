#pragma once
/// The node navigate: actions navigate_to and move_base, topic move_base_simple/goal.

namespace robot_control {

/// The body of main. Returns 0 after an end by a signal, 1 after a refusal, which is reported on stderr.
int run_navigate(int argc, char** argv);

}  // namespace robot_control
