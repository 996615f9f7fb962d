#include "rt/thread_counters.h"

#include <fstream>
#include <sstream>

namespace robot_control {
namespace {

/// Returns the value of a line "key: value" or "key value"; nothing if there is none.
std::optional<std::uint64_t> value_of(std::ifstream& file, const std::string& key) {
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with(key)) return std::stoull(line.substr(key.size()));
  }
  return std::nullopt;
}

}  // namespace

std::optional<ThreadCounters> read_thread_counters(int thread, const std::string& root) {
  const std::string number = std::to_string(thread);
  std::string folder = root;
  folder.append("/").append(number).append("/task/").append(number).append("/");
  ThreadCounters counters;

  std::ifstream stat(folder + "stat");
  std::string line;
  if (!std::getline(stat, line)) return std::nullopt;
  // A name may hold blanks and brackets; the state follows its last bracket, then come 6 numbers (proc(5)).
  std::istringstream fields(line.substr(line.rfind(')') + 1));
  std::string skipped;
  for (int i = 0; i < 7; ++i) fields >> skipped;
  std::uint64_t minor = 0, of_children = 0, major = 0;
  fields >> minor >> of_children >> major;
  counters.page_faults = minor + major;

  std::ifstream status(folder + "status");
  const auto voluntary = value_of(status, "voluntary_ctxt_switches:");
  const auto forced = value_of(status, "nonvoluntary_ctxt_switches:");
  if (!voluntary || !forced) return std::nullopt;  // the thread has ended
  counters.voluntary_switches = *voluntary;
  counters.forced_switches = *forced;

  std::ifstream schedule(folder + "schedstat");
  std::uint64_t ran_ns = 0, waited_ns = 0;
  if (schedule >> ran_ns >> waited_ns) counters.run_queue_ns = waited_ns;
  return counters;
}

MachineTime read_machine_time(const std::string& root) {
  std::ifstream stat(root + "/stat");
  std::string name;
  MachineTime time;
  stat >> name;
  constexpr int kFields = 8;  // user nice system idle iowait irq softirq steal; guests are part of user
  for (int i = 0; i < kFields; ++i) {
    std::uint64_t ticks = 0;
    if (!(stat >> ticks)) return {};
    time.total += ticks;
    if (i == kFields - 1) time.stolen = ticks;
  }
  return time;
}

}  // namespace robot_control
