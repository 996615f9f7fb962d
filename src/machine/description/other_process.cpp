#include "machine/description/other_process.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <fstream>
#include <string_view>

#include "files/descriptor.h"

namespace robot_control {
namespace {

/// Closed if it cannot be made.
struct Pipe {
  Pipe() {
    std::array<int, 2> ends{-1, -1};
    if (pipe2(ends.data(), O_CLOEXEC) == 0) reader = Descriptor(ends[0]), writer = Descriptor(ends[1]);
  }

  Descriptor reader, writer;
};

std::vector<std::string> overlaid(const std::vector<std::string>& over) {
  std::vector<std::string> result = over;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view given = *entry;
    bool is_hidden = false;
    for (const std::string& other : over) {
      is_hidden = is_hidden || given.starts_with(std::string_view(other).substr(0, other.find('=') + 1));
    }
    if (!is_hidden) result.emplace_back(given);
  }
  return result;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> result;
  for (std::string& text : texts) result.push_back(text.data());
  result.push_back(nullptr);
  return result;
}

pid_t spawn(std::vector<std::string> arguments, std::vector<std::string> environment, const Pipe& output,
            const Pipe& errors) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, output.writer.number(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, errors.writer.number(), STDERR_FILENO);
  pid_t child = -1;
  const int error = posix_spawnp(&child, arguments[0].c_str(), &actions, nullptr, pointers(arguments).data(),
                                 pointers(environment).data());
  posix_spawn_file_actions_destroy(&actions);
  return error == 0 ? child : -1;
}

/// Returns false at the end of the data.
bool read_some(int from, std::string& to) {
  std::array<char, 65536> block;
  const ssize_t got = read(from, block.data(), block.size());
  if (got < 0 && errno == EINTR) return true;
  if (got > 0) to.append(block.data(), static_cast<std::size_t>(got));
  return got > 0;
}

/// Reads until both are closed; returns false if they are silent for too long or write too much.
bool read_all(Pipe& output, Pipe& errors, int silence, ProcessResult& result) {
  while (output.reader.open() || errors.reader.open()) {
    // poll ignores a negative descriptor.
    std::array<pollfd, 2> watched{{{output.reader.number(), POLLIN, 0}, {errors.reader.number(), POLLIN, 0}}};
    const int ready = poll(watched.data(), watched.size(), silence * 1000);
    if (ready < 0 && errno == EINTR) continue;
    if (ready <= 0) return false;
    if (watched[0].revents != 0 && !read_some(output.reader.number(), result.output)) output.reader.close();
    if (watched[1].revents != 0 && !read_some(errors.reader.number(), result.errors)) errors.reader.close();
    if (result.output.size() > kMaxOutput || result.errors.size() > kMaxOutput) return false;
  }
  return true;
}

ProcessResult watched(pid_t child, Pipe& output, Pipe& errors, int silence) {
  ProcessResult result;
  output.writer.close();
  errors.writer.close();
  const bool is_complete = read_all(output, errors, silence, result);
  if (!is_complete) kill(child, SIGKILL);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  result.end = !is_complete        ? ProcessResult::End::kEnded
               : WIFEXITED(status) ? ProcessResult::End::kExited
                                   : ProcessResult::End::kKilled;
  result.code = WIFEXITED(status) ? WEXITSTATUS(status) : WTERMSIG(status);
  return result;
}

void limit(int resource, rlim_t value) {
  rlimit limits{};
  getrlimit(static_cast<__rlimit_resource>(resource), &limits);
  limits.rlim_cur = std::min(value, limits.rlim_max);
  setrlimit(static_cast<__rlimit_resource>(resource), &limits);
}

rlim_t address_space() {
  rlim_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
}

[[noreturn]] void work_apart(const std::function<std::string()>& work, const Pipe& output, const Pipe& errors) {
  dup2(errors.writer.number(), STDERR_FILENO);
  // A crash ends the process, without a handler of a sanitizer or of this program.
  for (const int signal_number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) std::signal(signal_number, SIG_DFL);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, kChildSeconds);
  limit(RLIMIT_AS, address_space() + kChildMemory);
  try {
    const std::string text = work();
    if (output.writer.write(text) != 0) _exit(1);
  } catch (...) {
    _exit(1);
  }
  _exit(0);
}

}  // namespace

ProcessResult run_program(const std::vector<std::string>& arguments, const std::vector<std::string>& environment,
                          int silence) {
  Pipe output;
  Pipe errors;
  if (!output.reader.open() || !errors.reader.open()) return {};
  const pid_t child = spawn(arguments, overlaid(environment), output, errors);
  if (child < 0) return {};
  return watched(child, output, errors, silence);
}

ProcessResult run_apart(const std::function<std::string()>& work) {
  Pipe output;
  Pipe errors;
  if (!output.reader.open() || !errors.reader.open()) return {};
  const pid_t child = fork();
  if (child < 0) return {};
  if (child == 0) work_apart(work, output, errors);
  return watched(child, output, errors, 2 * kChildSeconds);
}

}  // namespace robot_control
