#include "drivers/line/serial_port.h"

#include <fcntl.h>
#include <linux/serial.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include "drivers/driver.h"

namespace robot_control {
namespace {

struct BitRate {
  unsigned value;
  speed_t code;
};

constexpr std::array kBitRates{BitRate{9600, B9600},       BitRate{19200, B19200},     BitRate{38400, B38400},
                               BitRate{57600, B57600},     BitRate{115200, B115200},   BitRate{230400, B230400},
                               BitRate{460800, B460800},   BitRate{500000, B500000},   BitRate{921600, B921600},
                               BitRate{1000000, B1000000}, BitRate{2000000, B2000000}, BitRate{3000000, B3000000}};

const BitRate* find_rate(unsigned bit_rate) noexcept {
  const auto* found = std::ranges::find(kBitRates, bit_rate, &BitRate::value);
  return found == kBitRates.end() ? nullptr : found;
}

/// Returns the link of `links` that leads to this device; the address itself if there is none.
std::string by_id(const std::string& address, const std::string& links) {
  std::error_code ignored;
  const std::filesystem::path device = std::filesystem::canonical(address, ignored);
  for (const auto& link : std::filesystem::directory_iterator(links, ignored)) {
    if (!device.empty() && std::filesystem::canonical(link.path(), ignored) == device) return link.path().string();
  }
  return address;
}

void request_low_latency(int descriptor) noexcept {
  serial_struct serial{};
  if (ioctl(descriptor, TIOCGSERIAL, &serial) != 0) return;  // a device without a UART has none to request
  serial.flags |= ASYNC_LOW_LATENCY;
  ioctl(descriptor, TIOCSSERIAL, &serial);
}

void make_raw(int descriptor, unsigned bit_rate) noexcept {
  termios line{};
  tcgetattr(descriptor, &line);
  cfmakeraw(&line);
  line.c_cflag |= CLOCAL | CREAD;
  line.c_cflag &= ~(CRTSCTS | CSTOPB | HUPCL);  // HUPCL would reset an Arduino at the end of the program
  line.c_cc[VMIN] = 0;
  line.c_cc[VTIME] = 0;
  if (const BitRate* rate = find_rate(bit_rate); rate != nullptr) cfsetspeed(&line, rate->code);
  tcsetattr(descriptor, TCSANOW, &line);
  tcflush(descriptor, TCIOFLUSH);
}

}  // namespace

bool is_bit_rate(unsigned bit_rate) noexcept {
  return find_rate(bit_rate) != nullptr;
}

SerialPort::SerialPort(std::string address, unsigned bit_rate, const RealtimeParameters& thread,
                       std::function<std::int64_t()> clock, std::string links)
    : address_(std::move(address)),
      bit_rate_(bit_rate),
      clock_(std::move(clock)),
      file_(open("/dev/null", O_RDWR | O_CLOEXEC)) {
  if (!address_.starts_with("/dev/serial/")) address_ = by_id(address_, links);
  if (!file_.open()) throw DriverError(std::string("/dev/null cannot be opened: ") + std::strerror(errno));
  try_open();
  thread_ = std::make_unique<RealtimeThread>(thread, [this] { run(); });
}

SerialPort::~SerialPort() {
  ending_ = true;
  thread_.reset();
}

/// Returns false if there is no device. Throws DriverError if it cannot be used.
bool SerialPort::try_open() {
  const Descriptor device(open(address_.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (!device.open() && (errno == ENOENT || errno == ENXIO || errno == ENODEV || errno == EIO)) return false;
  const auto refuse = [&](const std::string& why) {
    throw DriverError("the serial line " + address_ + " cannot be used: " + why);
  };
  if (!device.open() && errno == EBUSY) refuse("another program uses it. Stop that program");
  if (!device.open()) {
    refuse(std::string(std::strerror(errno)) +
           (errno == EACCES ? ". Add this user to the group dialout, and log in again" : ""));
  }
  if (isatty(device.number()) == 0) refuse("it is not a tty. Set the device of the board (board.address)");
  if (flock(device.number(), LOCK_EX | LOCK_NB) != 0) refuse("another program uses it. Stop that program");
  ioctl(device.number(), TIOCEXCL);
  make_raw(device.number(), bit_rate_);
  request_low_latency(device.number());
  dup2(device.number(), file_.number());
  fcntl(file_.number(), F_SETFD, FD_CLOEXEC);
  connected_ = true;
  return true;
}

void SerialPort::disconnect() noexcept {
  connected_ = false;
  const Descriptor nothing(open("/dev/null", O_RDWR | O_CLOEXEC));
  if (nothing.open()) dup2(nothing.number(), file_.number());
}

void SerialPort::run() noexcept {
  while (!ending_) {
    if (!connected_) {
      poll(nullptr, 0, kRetryMs);
      try {
        try_open();
      } catch (const DriverError&) {  // not yet: its permissions follow its appearance
      }
      continue;
    }
    pollfd wait{.fd = file_.number(), .events = POLLIN, .revents = 0};
    if (poll(&wait, 1, kRetryMs) > 0) read_available();
  }
}

void SerialPort::read_available() noexcept {
  SerialChunk chunk;
  const ssize_t got = read(file_.number(), chunk.bytes.data(), chunk.bytes.size());
  if (got < 0 && (errno == EAGAIN || errno == EINTR)) return;
  if (got <= 0) {
    disconnect();
    return;
  }
  chunk.time_ns = clock_();
  chunk.size = static_cast<std::size_t>(got);
  const std::size_t written = written_.load(std::memory_order_relaxed);
  if (written - taken_.load(std::memory_order_acquire) == kChunks) {
    ++dropped_;
    return;
  }
  chunks_[written % kChunks] = chunk;
  written_.store(written + 1, std::memory_order_release);
}

bool SerialPort::receive(SerialChunk& chunk) noexcept {
  const std::size_t taken = taken_.load(std::memory_order_relaxed);
  if (written_.load(std::memory_order_acquire) == taken) return false;
  chunk = chunks_[taken % kChunks];
  taken_.store(taken + 1, std::memory_order_release);
  return true;
}

bool SerialPort::send(std::span<const std::uint8_t> bytes) noexcept {
  if (!connected_) return false;
  return write(file_.number(), bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size());
}

}  // namespace robot_control
