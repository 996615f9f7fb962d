#include "simulation/devices/pseudo_terminal.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "drivers/driver.h"

namespace robot_control {

PseudoTerminal::PseudoTerminal(std::string path) : path_(std::move(path)) {
  struct stat left {};
  if (lstat(path_.c_str(), &left) == 0 && !S_ISLNK(left.st_mode))
    throw DriverError(path_ + " is no link to a tty. Choose another address (board.address)");
  plug();
}

PseudoTerminal::~PseudoTerminal() {
  unplug();
}

void PseudoTerminal::plug() {
  unplug();
  std::array<char, 64> name{};
  descriptor_ = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  termios line{};
  const bool made = descriptor_ >= 0 && grantpt(descriptor_) == 0 && unlockpt(descriptor_) == 0 &&
                    ptsname_r(descriptor_, name.data(), name.size()) == 0 && tcgetattr(descriptor_, &line) == 0;
  cfmakeraw(&line);
  if (made && tcsetattr(descriptor_, TCSANOW, &line) == 0 && symlink(name.data(), path_.c_str()) == 0) return;
  const std::string why = std::strerror(errno);
  unplug();
  throw DriverError("no tty can be made at " + path_ + ": " + why + ". Choose another address (board.address)");
}

void PseudoTerminal::unplug() noexcept {
  struct stat link {};
  if (lstat(path_.c_str(), &link) == 0 && S_ISLNK(link.st_mode)) unlink(path_.c_str());
  if (descriptor_ >= 0) close(descriptor_);
  descriptor_ = -1;
}

bool PseudoTerminal::receive(SerialChunk& chunk) noexcept {
  const ssize_t got = descriptor_ < 0 ? -1 : read(descriptor_, chunk.bytes.data(), chunk.bytes.size());
  chunk.size = got > 0 ? static_cast<std::size_t>(got) : 0;
  return chunk.size > 0;
}

bool PseudoTerminal::send(std::span<const std::uint8_t> bytes) noexcept {
  return descriptor_ >= 0 && write(descriptor_, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size());
}

}  // namespace robot_control
