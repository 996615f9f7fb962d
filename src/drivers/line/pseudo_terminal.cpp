#include "drivers/line/pseudo_terminal.h"

#include <fcntl.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <utility>

#include "drivers/driver.h"

namespace robot_control {

PseudoTerminal::PseudoTerminal(std::string path) : path_(std::move(path)) {
  std::error_code ignored;
  const auto left = std::filesystem::symlink_status(path_, ignored);
  const std::string remedy = ", or set another address (board.address)";
  if (std::filesystem::exists(left) && !std::filesystem::is_symlink(left))
    throw DriverError("no tty can be created at " + path_ + ", which is not a link. Remove it" + remedy);
  if (std::filesystem::exists(path_, ignored)) {
    throw DriverError("no tty can be created at " + path_ + ", which leads to " +
                      std::filesystem::read_symlink(path_, ignored).string() +
                      " in use. Stop the program that created it" + remedy);
  }
  std::filesystem::remove(path_, ignored);  // of a program that was killed
  plug();
}

void PseudoTerminal::plug() {
  unplug();
  std::array<char, 64> name{};
  descriptor_ = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  termios line{};
  const bool made = descriptor_ >= 0 && grantpt(descriptor_) == 0 && unlockpt(descriptor_) == 0 &&
                    ptsname_r(descriptor_, name.data(), name.size()) == 0 && tcgetattr(descriptor_, &line) == 0;
  cfmakeraw(&line);
  tty_ = name.data();
  if (made && tcsetattr(descriptor_, TCSANOW, &line) == 0 && symlink(name.data(), path_.c_str()) == 0) return;
  const std::string why = std::strerror(errno);
  unplug();
  throw DriverError("no tty can be created at " + path_ + ": " + why + ". Set another address (board.address)");
}

void PseudoTerminal::unplug() noexcept {
  if (descriptor_ < 0) return;
  std::array<char, 64> target{};
  const ssize_t size = readlink(path_.c_str(), target.data(), target.size());
  if (size > 0 && std::string_view(target.data(), static_cast<std::size_t>(size)) == tty_) unlink(path_.c_str());
  close(descriptor_);
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
