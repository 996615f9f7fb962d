#pragma once
/// A forked process that runs a function and exits with its result. Killed, if it still lives, at the end.

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

  /// SIGKILL, and gone on return.
  void kill() noexcept {
    if (id_ <= 0) return;
    ::kill(id_, SIGKILL);
    wait();
  }

  /// The exit code; -1 after a signal.
  int wait() noexcept {
    if (id_ <= 0) return -1;
    int status = 0;
    while (waitpid(id_, &status, 0) < 0 && errno == EINTR) {
    }
    id_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  pid_t id() const noexcept { return id_; }

 private:
  pid_t id_;
};

}  // namespace robot_control
