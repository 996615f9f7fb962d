/// Prints the text of msg/Trace.msg (tests/docs/trace_message.py).

#include <cstdio>

#include "log/fields/trace_fields.h"

int main() {
  std::fputs(robot_control::trace_definition().c_str(), stdout);
  return 0;
}
