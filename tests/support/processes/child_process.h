#pragma once
/// A forked process that runs a function and exits with its result. It is killed at the end if it still lives.

#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <exception>

namespace robot_control {

class ChildProcess {
 public:
  static constexpr int kThrew = 99;  ///< exit code of a body that threw

  /// `body` returns the exit code. The caller must have no other thread.
  template <class Body>
  explicit ChildProcess(Body body) : id_(fork()) {
    if (id_ != 0) return;
    int code = kThrew;
    try {
      code = body();
    } catch (const std::exception&) {
    }
    _exit(code);
  }
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;
  ~ChildProcess() { kill(); }

  /// Sends SIGKILL and waits for the end.
  void kill() noexcept {
    if (id_ <= 0) return;
    ::kill(id_, SIGKILL);
    wait();
  }

  /// The exit code; -1 after a signal.
  int wait() noexcept {
    if (id_ > 0) collect(0);
    return code_;
  }

  /// True if it still lives, even stopped.
  bool lives() noexcept {
    if (id_ > 0) collect(WNOHANG);
    return id_ > 0;
  }

  void send(int signal) const noexcept {
    if (id_ > 0) ::kill(id_, signal);
  }

  /// Sends SIGSTOP or a signal that ends it. After SIGSTOP it waits until all threads stand still, which takes time if
  /// they have no core. After SIGKILL it does not wait: no thread runs again, but the kernel frees memory for many
  /// cycles.
  void stop_with(int signal) const noexcept {
    if (id_ <= 0) return;
    ::kill(id_, signal);
    siginfo_t info{};
    while (signal == SIGSTOP && waitid(P_PID, static_cast<id_t>(id_), &info, WSTOPPED | WEXITED | WNOWAIT) < 0 &&
           errno == EINTR) {
    }
  }

  /// The exit code of a process that has ended: -1 after a signal.
  int code() const noexcept { return code_; }
  /// The signal that ended it; 0: none.
  int ending_signal() const noexcept { return signal_; }

  pid_t id() const noexcept { return id_; }

 private:
  void collect(int options) noexcept {
    int status = 0;
    pid_t done = -1;
    while ((done = waitpid(id_, &status, options)) < 0 && errno == EINTR) {
    }
    if (done == 0) return;
    id_ = 0;
    code_ = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    signal_ = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  }

  pid_t id_;
  int code_ = -1;
  int signal_ = 0;
};

}  // namespace robot_control
