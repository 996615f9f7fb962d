#include "rt/crash_report.h"

#include <poll.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace robot_control {
namespace {

struct FatalSignal {
  int signal;
  std::string_view name;
  std::string_view what;
  std::string_view remedy;
};

constexpr std::string_view kReportRemedy = "report its core dump (coredumpctl), then restart the node";
constexpr FatalSignal kFatalSignals[] = {
    {SIGBUS, "SIGBUS", "shared memory was truncated, or its file system is full",
     "check 'df /dev/shm' and the processes that write there, then restart the node"},
    {SIGSEGV, "SIGSEGV", "it accessed an invalid address", kReportRemedy},
    {SIGILL, "SIGILL", "it reached an invalid instruction", kReportRemedy},
    {SIGFPE, "SIGFPE", "it divided an integer by zero", kReportRemedy},
    {SIGABRT, "SIGABRT", "it aborted; the message before gives the reason", kReportRemedy},
};

/// A Text holds at most Size bytes; the rest is cut.
template <std::size_t Size>
class Text {
 public:
  void add(std::string_view text) noexcept {
    const std::size_t fits = std::min(text.size(), Size - size_);
    std::memcpy(memory_.data() + size_, text.data(), fits);
    size_ += fits;
  }
  void add_address(std::uintptr_t address) noexcept {
    add("0x");
    int shift = 8 * static_cast<int>(sizeof address) - 4;
    while (shift > 0 && address >> shift == 0) shift -= 4;
    for (; shift >= 0; shift -= 4) add(std::string_view("0123456789abcdef").substr((address >> shift) & 15, 1));
  }
  std::string_view view() const noexcept { return {memory_.data(), size_}; }

 private:
  std::size_t size_ = 0;
  std::array<char, Size> memory_{};
};

// These texts are complete before the handlers are installed, and never change afterwards.
Text<kMaxName> node_name;
Text<kMaxConsequence> consequence_of_death;

std::atomic<bool> dying{false};

/// Writes the line if stderr accepts it at once: a reader that has stopped must not keep the process alive.
void say(std::string_view line) noexcept {
  pollfd ready{.fd = STDERR_FILENO, .events = POLLOUT, .revents = 0};
  if (poll(&ready, 1, 0) != 1 || (ready.revents & POLLOUT) == 0) return;
  [[maybe_unused]] const auto written = write(STDERR_FILENO, line.data(), line.size());
}

void speak(const FatalSignal& death, const siginfo_t& info) noexcept {
  Text<512> line;
  line.add(node_name.view());
  line.add(": ");
  line.add(death.name);
  if (info.si_code > 0 && death.signal != SIGABRT) {
    line.add(" at ");
    line.add_address(reinterpret_cast<std::uintptr_t>(info.si_addr));
  } else if (info.si_code == SI_USER) {
    line.add(" from another process");
  }
  line.add(": ");
  line.add(death.what);
  line.add("; the process ends, ");
  line.add(consequence_of_death.view());
  line.add("; remedy: ");
  line.add(death.remedy);
  line.add("\n");
  say(line.view());
}

/// Repeats the signal with the default action and the same cause; it is delivered when the handler returns.
void die_of(int signal, siginfo_t& info) noexcept {
  struct sigaction action {};
  action.sa_handler = SIG_DFL;
  sigaction(signal, &action, nullptr);
  if (syscall(SYS_rt_tgsigqueueinfo, getpid(), gettid(), signal, &info) != 0) raise(signal);
}

extern "C" void report_crash(int signal, siginfo_t* info, void* /*context*/) {
  // A second failing thread waits here: its end would interrupt the report of the first one.
  while (dying.exchange(true)) pause();
  for (const FatalSignal& death : kFatalSignals) {
    if (death.signal == signal) speak(death, *info);
  }
  die_of(signal, *info);
}

}  // namespace

void install_crash_report(const std::string& name, const std::string& consequence) {
  static AlternateStack stack;
  node_name = {};
  node_name.add(name);
  consequence_of_death = {};
  consequence_of_death.add(consequence);
  struct sigaction action {};
  action.sa_sigaction = &report_crash;
  action.sa_flags = SA_SIGINFO | SA_ONSTACK;
  sigfillset(&action.sa_mask);
  for (const FatalSignal& death : kFatalSignals) sigaction(death.signal, &action, nullptr);
}

AlternateStack::AlternateStack() noexcept {
  stack_t present{};
  if (sigaltstack(nullptr, &present) != 0 || (present.ss_flags & SS_DISABLE) == 0) return;
  const stack_t mine{.ss_sp = memory_.data(), .ss_flags = 0, .ss_size = memory_.size()};
  mine_ = sigaltstack(&mine, nullptr) == 0;
}

AlternateStack::~AlternateStack() {
  if (!mine_) return;
  const stack_t none{.ss_sp = nullptr, .ss_flags = SS_DISABLE, .ss_size = 0};
  sigaltstack(&none, nullptr);
}

}  // namespace robot_control
