#pragma once
/// A PseudoTerminal is the device's end of a serial line between two programs. Its other end is a tty, to which a link
/// at the given path leads, as one of /dev/serial/by-id leads to a device. `unplug` and `plug` make another tty.

#include "drivers/line/serial_line.h"

namespace robot_control {

class PseudoTerminal final : public SerialLine {
 public:
  /// A link that leads nowhere is replaced. Throws DriverError if `path` is taken by anything else, as by the link of a
  /// running simulator, or cannot be made.
  explicit PseudoTerminal(std::string path);
  ~PseudoTerminal() override { unplug(); }
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;

  bool receive(SerialChunk& chunk) noexcept override;
  bool send(std::span<const std::uint8_t> bytes) noexcept override;
  bool connected() const noexcept override { return descriptor_ >= 0; }
  std::string name() const override { return path_; }

  void unplug() noexcept;
  /// Throws DriverError.
  void plug();

 private:
  std::string path_;
  std::string tty_;  // to which the link leads
  int descriptor_ = -1;
};

}  // namespace robot_control
