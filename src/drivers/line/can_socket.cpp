#include "drivers/line/can_socket.h"

#include <fcntl.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "drivers/driver.h"
#include "files/message_text.h"

namespace robot_control {
namespace {

constexpr char kFolderPrefix[] = "unix:";

std::string reason() {
  return std::strerror(errno);
}

[[noreturn]] void refuse(const std::string& address, const std::string& problem, const std::string& remedy) {
  throw DriverError("CAN bus " + printable(address) + ": " + problem + "; " + remedy);
}

sockaddr* generic(void* address) {
  return static_cast<sockaddr*>(address);
}

/// The folder while its names change hands.
Descriptor locked_folder(const std::string& path) {
  const auto fail = [&](const std::string& problem, const std::string& remedy) {
    refuse(kFolderPrefix + path, problem, remedy);
  };
  if (mkdir(path.c_str(), 0700) != 0 && errno != EEXIST) fail(reason(), "its parent folder must exist and be writable");
  Descriptor folder(open(path.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
  struct stat status {};
  if (!folder.open() || fstat(folder.number(), &status) != 0) fail(reason(), "set a folder of your own");
  if (status.st_uid != geteuid() || (status.st_mode & (S_IWGRP | S_IWOTH)) != 0) {
    fail("other users may write to this folder", "set a folder of your own: chmod 700");
  }
  flock(folder.number(), LOCK_EX);
  return folder;
}

sockaddr_un party_address(const std::string& folder, unsigned party) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string path = folder + "/" + std::to_string(party);
  if (path.size() >= sizeof address.sun_path) {
    refuse(kFolderPrefix + folder, "the path has " + std::to_string(folder.size()) + " bytes",
           "a socket allows at most " + std::to_string(sizeof address.sun_path - 4));
  }
  path.copy(address.sun_path, path.size());
  return address;
}

Descriptor datagram_socket() {
  return Descriptor(socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
}

/// Returns whether the name is left over from an ended process.
bool abandoned(sockaddr_un address) {
  const Descriptor probe = datagram_socket();
  return connect(probe.number(), generic(&address), sizeof address) != 0 && errno == ECONNREFUSED;
}

}  // namespace

CanSocket CanSocket::open(const std::string& address, std::span<const can_filter> filters, bool fd) {
  CanSocket opened(-1, filters);
  if (address.starts_with(kFolderPrefix)) {
    opened.open_folder(address.substr(sizeof kFolderPrefix - 1));
  } else {
    opened.open_interface(address, fd);
  }
  return opened;
}

CanSocket::CanSocket(int descriptor, std::span<const can_filter> filters)
    : descriptor_(descriptor), filters_(filters.begin(), filters.end()) {
  if (descriptor >= 0) request_time_stamps();
}

CanSocket CanSocket::line_end(int descriptor) {
  CanSocket end(-1);
  end.descriptor_ = Descriptor(descriptor);
  end.is_line_ = true;
  return end;
}

CanSocket::~CanSocket() {
  if (own_party_ < parties_.size()) unlink(parties_[own_party_].sun_path);
}

bool CanSocket::passes(canid_t id) const noexcept {
  for (const can_filter& filter : filters_) {
    const bool inverted = (filter.can_id & CAN_INV_FILTER) != 0;
    if (((id ^ filter.can_id) & filter.can_mask) == 0 ? !inverted : inverted) return true;
  }
  return filters_.empty();
}

void CanSocket::request_time_stamps() const noexcept {
  const int on = 1;  // a socket that has none of these is still a socket
  setsockopt(descriptor(), SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on);
  setsockopt(descriptor(), SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof on);
}

void CanSocket::open_interface(const std::string& name, bool fd) {
  if (name.empty() || name.size() >= IFNAMSIZ) {
    refuse(name, "this is not the name of an interface", "set can0, or unix:FOLDER");
  }
  descriptor_ = Descriptor(socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, CAN_RAW));
  if (!descriptor_.open()) {
    const bool absent = errno == EAFNOSUPPORT;
    refuse(name, absent ? "this kernel does not support CAN" : reason(),
           "load the modules can and can_raw, or use unix:FOLDER for simulated drives");
  }
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(if_nametoindex(name.c_str()));
  if (address.can_ifindex == 0) refuse(name, reason(), "`ip link` lists the interfaces");
  ifreq state{};
  name.copy(state.ifr_name, name.size());
  const std::string up = "ip link set " + printable(name) + " up type can bitrate BIT_RATE " +
                         (fd ? "dbitrate DATA_RATE fd on " : "") + "restart-ms 100";
  if (ioctl(descriptor(), SIOCGIFFLAGS, &state) == 0 && (state.ifr_flags & IFF_UP) == 0)
    refuse(name, "the interface is down", up);
  if (fd && ioctl(descriptor(), SIOCGIFMTU, &state) == 0 && state.ifr_mtu < static_cast<int>(kFdFrameBytes))
    refuse(name, "the interface does not carry frames of CAN FD", "set it down, then " + up);
  const can_err_mask_t errors = CAN_ERR_MASK;
  const int on = 1;
  if (setsockopt(descriptor(), SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &errors, sizeof errors) != 0 ||
      (fd && setsockopt(descriptor(), SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &on, sizeof on) != 0) ||
      (!filters_.empty() && setsockopt(descriptor(), SOL_CAN_RAW, CAN_RAW_FILTER, filters_.data(),
                                       static_cast<socklen_t>(filters_.size() * sizeof(can_filter))) != 0) ||
      bind(descriptor(), generic(&address), sizeof address) != 0) {
    refuse(name, reason(), "check that it is a CAN interface");
  }
  request_time_stamps();
}

void CanSocket::open_folder(const std::string& folder) {
  for (unsigned party = 0; party < kMaxParties; ++party) parties_.push_back(party_address(folder, party));
  own_party_ = kMaxParties;
  const Descriptor lock = locked_folder(folder);
  descriptor_ = datagram_socket();
  if (!descriptor_.open()) refuse(kFolderPrefix + folder, reason(), "stop other programs");
  for (const sockaddr_un& party : parties_) {
    if (abandoned(party)) unlink(party.sun_path);
  }
  bind_first_free_name();
  if (own_party_ == kMaxParties) {
    refuse(kFolderPrefix + folder, "no free name: " + reason(),
           "at most " + std::to_string(kMaxParties) + " programs share a folder");
  }
  request_time_stamps();
}

void CanSocket::bind_first_free_name() {
  for (unsigned party = 0; party < kMaxParties; ++party) {
    if (bind(descriptor(), generic(&parties_[party]), sizeof(sockaddr_un)) == 0) {
      own_party_ = party;
      return;
    }
    if (errno != EADDRINUSE) return;
  }
}

}  // namespace robot_control
