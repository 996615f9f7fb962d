/// The stamps [ns] of the newest frames in shared memory, in the order of TraceRing, of nodes that may have been
/// killed:
///
///   rc_newest_stamps --bus NAME
///
/// The exit code is 1 if a channel has none.

#include <cinttypes>
#include <cstdio>
#include <string_view>

#include "loop/processes/process.h"
#include "signals/command_frame.h"
#include "signals/permit.h"
#include "signals/sensor_frame.h"
#include "signals/state_frame.h"

namespace robot_control {
namespace {

template <class Frame>
std::int64_t newest_stamp(const char* bus, const char* channel) {
  Input<Frame> input(bus, channel);
  input.poll();
  Frame frame;
  return input.reader.newest(frame) == Lookup::kFrame ? frame.head.stamp_ns : 0;
}

bool print_stamps(const char* bus) {
  bool all = true;
  for (const std::int64_t stamp_ns :
       {newest_stamp<SensorFrame>(bus, ChannelNames::kSensors), newest_stamp<StateFrame>(bus, ChannelNames::kState),
        newest_stamp<CommandFrame>(bus, ChannelNames::kCommand), newest_stamp<Permit>(bus, ChannelNames::kPermit)}) {
    std::printf("%" PRId64 "\n", stamp_ns);
    all = all && stamp_ns != 0;
  }
  return all;
}

}  // namespace
}  // namespace robot_control

int main(int argc, char** argv) {
  if (argc != 3 || std::string_view(argv[1]) != "--bus") {
    std::fprintf(stderr, "rc_newest_stamps: --bus NAME wanted\n");
    return 1;
  }
  return robot_control::print_stamps(argv[2]) ? 0 : 1;
}
