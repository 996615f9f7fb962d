/// Processes crash and report it. Each is a child of its own.

#include "rt/crash_report.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <thread>

#include "rt/realtime_thread.h"
#include "support/matchers.h"

namespace robot_control::tests {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif

struct Death {
  std::string words;  ///< all of stderr
  int signal = 0;     ///< 0: it lived
};

/// Runs `body` in a child with a crash report and its stderr in a pipe.
Death death_of(const std::function<void()>& body, bool reader_stopped = false) {
  int pipe_ends[2];
  if (pipe(pipe_ends) != 0) throw std::runtime_error("no pipe");
  const pid_t child = fork();
  if (child == 0) {
    const rlimit no_core{0, 0};
    setrlimit(RLIMIT_CORE, &no_core);
    dup2(pipe_ends[1], STDERR_FILENO);
    if (reader_stopped) {
      fcntl(STDERR_FILENO, F_SETFL, O_NONBLOCK);
      const std::array<char, 4096> filling{};
      while (write(STDERR_FILENO, filling.data(), filling.size()) > 0) {
      }
      fcntl(STDERR_FILENO, F_SETFL, 0);
    }
    install_crash_report("some_node", "the motors brake without it");
    body();
    _exit(0);
  }
  close(pipe_ends[1]);
  Death death;
  int status = 0;
  if (reader_stopped) waitpid(child, &status, 0);
  std::array<char, 4096> part;
  for (;;) {
    const ssize_t size = read(pipe_ends[0], part.data(), part.size());
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) break;
    death.words.append(part.data(), static_cast<std::size_t>(size));
  }
  close(pipe_ends[0]);
  if (!reader_stopped) waitpid(child, &status, 0);
  death.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  return death;
}

long lines_of(const std::string& text) {
  return std::count(text.begin(), text.end(), '\n');
}

/// Reads shared memory that was truncated after it was mapped.
void read_truncated() {
  const int file = memfd_create("some_channel", 0);
  if (file < 0 || ftruncate(file, 4096) != 0) _exit(1);
  auto* memory = static_cast<volatile char*>(mmap(nullptr, 4096, PROT_READ, MAP_SHARED, file, 0));
  if (ftruncate(file, 0) != 0) _exit(1);
  static_cast<void>(memory[100]);
}

void write_nowhere() {
  volatile std::uintptr_t nowhere = 0x10;
  *reinterpret_cast<volatile int*>(nowhere) = 1;
}

/// Recurses endlessly, in a form that the optimiser cannot turn into a loop.
[[gnu::noinline]] int overflow(int depth) {
  volatile char frame[4096];
  frame[depth % 4096] = 1;
  return depth < 0 ? 0 : overflow(depth + 1) + frame[depth % 4096];
}

TEST(CrashReport, TruncatedSharedMemoryIsNamedWithItsRemedyAndTheConsequence) {
  const Death death = death_of(read_truncated);
  EXPECT_EQ(death.signal, SIGBUS);
  EXPECT_EQ(lines_of(death.words), 1);
  EXPECT_THAT(death.words,
              AllOf(StartsWith("some_node: SIGBUS at 0x"), HasSubstr("shared memory was truncated"),
                    HasSubstr("the process ends, the motors brake without it"), HasSubstr("remedy: check 'df")));
}

TEST(CrashReport, NamesTheSignalAndItsReasonInOneLine) {
  const std::vector<std::tuple<std::function<void()>, int, std::string>> crashes{
      {write_nowhere, SIGSEGV, "SIGSEGV at 0x10: "},
      {[] { __builtin_trap(); }, SIGILL, "SIGILL at 0x"},
      {[] { raise(SIGFPE); }, SIGFPE, "SIGFPE: it divided"},
      {[] { std::abort(); }, SIGABRT, "SIGABRT: it aborted"},
      {[] { kill(getpid(), SIGSEGV); }, SIGSEGV, "SIGSEGV from another process: "},
      {[] { std::thread(read_truncated).join(); }, SIGBUS, "SIGBUS at 0x"}};
  for (const auto& [body, signal, words] : crashes) {
    const Death death = death_of(body);
    EXPECT_EQ(death.signal, signal) << words;
    EXPECT_EQ(lines_of(death.words), 1) << words;
    EXPECT_THAT(death.words,
                AllOf(StartsWith("some_node: " + words), HasSubstr(signal == SIGBUS ? "remedy: " : "core dump")));
  }
}

TEST(CrashReport, ALivingProcessReportsNothing) {
  const Death death = death_of([] {});
  EXPECT_EQ(death.signal, 0);
  EXPECT_EQ(death.words, "");
}

TEST(CrashReport, ThreadsThatCrashTogetherReportOnce) {
  for (int trial = 0; trial < 20; ++trial) {
    const Death death = death_of([] {
      std::atomic<int> ready{0};
      std::vector<std::thread> threads;
      for (int i = 0; i < 4; ++i) {
        threads.emplace_back([&] {
          for (++ready; ready < 4;) std::this_thread::yield();
          write_nowhere();
        });
      }
      for (std::thread& thread : threads) thread.join();
    });
    ASSERT_EQ(death.signal, SIGSEGV);
    ASSERT_EQ(lines_of(death.words), 1) << death.words;
  }
}

TEST(CrashReport, AStackOverflowOfAnyThreadIsReported) {
  if (kSanitized) GTEST_SKIP() << "the sanitizer's frames are too large for it";
  for (const bool realtime : {false, true}) {
    const Death death = death_of([realtime] {
      if (!realtime) overflow(0);
      RealtimeThread({.policy = RealtimePolicy::kOff}, [] { overflow(0); }).join();
    });
    EXPECT_EQ(death.signal, SIGSEGV);
    EXPECT_THAT(death.words, StartsWith("some_node: SIGSEGV at 0x"));
  }
}

// Otherwise it would hang in the write, and with it this test.
TEST(CrashReport, AReaderThatHasStoppedDoesNotKeepItAlive) {
  const Death death = death_of(write_nowhere, true);
  EXPECT_EQ(death.signal, SIGSEGV);
  EXPECT_THAT(death.words, Not(HasSubstr("some_node")));
}

TEST(CrashReport, EndsTheProcessByTheSameSignalWithoutAStderr) {
  const Death death = death_of([] {
    close(STDERR_FILENO);
    write_nowhere();
  });
  EXPECT_EQ(death.signal, SIGSEGV);
  EXPECT_EQ(death.words, "");
}

TEST(CrashReport, ALongNameIsCutOff) {
  const Death death = death_of([] {
    install_crash_report(std::string(1000, 'x'), std::string(1000, 'y'));
    write_nowhere();
  });
  EXPECT_EQ(death.signal, SIGSEGV);
  EXPECT_EQ(lines_of(death.words), 1);
  EXPECT_LT(death.words.size(), 512u);
  EXPECT_THAT(death.words, HasSubstr("remedy: "));
}

}  // namespace robot_control::tests
