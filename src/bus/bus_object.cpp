#include "bus/bus_object.h"

#include <pwd.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <climits>
#include <cstddef>
#include <system_error>

#include "rt/futex.h"
#include "signals/formatted_text.h"

namespace robot_control {
namespace {

constexpr int kClaimTries = 100;  // each lost try means that another process changed the name meanwhile
constexpr int kSettleTries = 10;
constexpr int kLockTries = 30;  // a process that removes ended buses holds their locks for a millisecond
constexpr std::int64_t kSettleNs = 10'000'000;  // a claim holds an object that it will replace for some µs

/// The part of ChannelHead that keeps its place.
struct HeadStart {
  std::uint64_t magic = 0;
  std::uint64_t layout_version = 0;
  std::uint64_t frame_bytes = 0;
  std::uint64_t slots = 0;
  std::uint64_t retired = 0;
};
static_assert(offsetof(ChannelHead, frame_bytes) == offsetof(HeadStart, frame_bytes));
static_assert(offsetof(ChannelHead, retired) == offsetof(HeadStart, retired));

enum class Finding {
  kUsable,
  kEmpty,      ///< being made, or its maker died
  kTruncated,  ///< shorter than a head, or than its head states
  kForeign,    ///< not of this software
  kOtherLayout,
  kRetired,
};

Finding inspect(const SharedMemory& object, const BusLayout& layout) {
  const std::size_t bytes = object.bytes();
  if (bytes == 0) return Finding::kEmpty;
  HeadStart head;
  if (!object.read_at(0, &head, sizeof head)) return Finding::kTruncated;
  if (head.magic == 0) return Finding::kEmpty;
  if (head.magic != kChannelMagic) return Finding::kForeign;
  if (head.retired != 0) return Finding::kRetired;
  if (head.layout_version != kLayoutVersion || head.frame_bytes != layout.frame_bytes || head.slots != layout.slots) {
    return Finding::kOtherLayout;
  }
  if (bytes < layout.object_bytes) return Finding::kTruncated;
  return bytes == layout.object_bytes ? Finding::kUsable : Finding::kOtherLayout;
}

const char* text(Finding finding) {
  switch (finding) {
    case Finding::kEmpty:
      return "has no content yet";
    case Finding::kTruncated:
      return "is truncated";
    case Finding::kForeign:
      return "was not written by robot_control";
    case Finding::kOtherLayout:
      return "has another layout";
    case Finding::kRetired:
      return "is retired";
    case Finding::kUsable:
      break;
  }
  return "is usable";
}

std::string file_of(const std::string& name) {
  return "/dev/shm" + name;
}

[[noreturn]] void fail(const std::string& channel, const std::string& name, const std::string& why,
                       const std::string& remedy) {
  throw BusError("channel '" + channel + "' (" + file_of(name) + "): " + why + "; remedy: " + remedy);
}

std::string user_name(uid_t user) {
  const passwd* const entry = getpwuid(user);
  return entry == nullptr ? "user " + std::to_string(user)
                          : "'" + std::string(entry->pw_name) + "' (" + std::to_string(user) + ")";
}

const char* kind_text(mode_t mode) {
  if (S_ISLNK(mode)) return "a symbolic link";
  if (S_ISDIR(mode)) return "a directory";
  if (S_ISFIFO(mode)) return "a pipe";
  return "a device or socket";
}

/// The object of this name is open to other users. It is refused, and its mode is not corrected: another process may
/// still have it open.
[[noreturn]] void fail_not_private(const std::string& channel, const std::string& name) {
  const std::string file = file_of(name);
  const std::string listing = "see 'ls -l " + file + "'; ";
  struct stat status {};
  if (lstat(file.c_str(), &status) != 0) {
    fail(channel, name, "cannot be opened or created by " + user_name(geteuid()),
         "set the mode of /dev/shm to 1777, or set another parameter 'bus'");
  }
  if (status.st_uid != geteuid()) {
    fail(channel, name, "belongs to " + user_name(status.st_uid) + ", and this node runs as " + user_name(geteuid()),
         listing + "remove it as its owner or root, start all nodes as one user, or set another parameter 'bus'");
  }
  if (!S_ISREG(status.st_mode)) {
    fail(channel, name, std::string(kind_text(status.st_mode)) + " has its name", listing + "remove it");
  }
  fail(channel, name,
       formatted("its mode is %04o, and must be 0600: other users may have it open", status.st_mode & 07777U),
       listing + "stop all nodes and remove it; the next start creates it again");
}

/// A shortage of descriptors, in this process or on the whole machine, is temporary.
bool is_shortage(const std::system_error& error) {
  return error.code().value() == EMFILE || error.code().value() == ENFILE;
}

[[noreturn]] void fail_system(const std::string& channel, const std::string& name, const std::system_error& error) {
  struct stat status {};
  if (lstat(file_of(name).c_str(), &status) == 0 && !S_ISREG(status.st_mode)) fail_not_private(channel, name);
  switch (error.code().value()) {
    case EACCES:
    case EPERM:
      fail_not_private(channel, name);
    case ENOSPC:
    case ENOMEM:
      fail(channel, name, error.what(), "free memory in /dev/shm ('df -h /dev/shm'; in a container --shm-size=256m)");
    case EMFILE:
    case ENFILE:
      fail(channel, name, error.what(),
           "set a larger limit of open files (ulimit -n 1024; of the computer: fs.file-max)");
    case EFBIG:
      fail(channel, name, error.what(), "set a larger limit of the file size ('ulimit -f unlimited')");
    default:
      fail(channel, name, error.what(), "check that /dev/shm is a writable tmpfs");
  }
}

template <class Action>
auto reporting(const std::string& channel, const std::string& name, Action action) {
  try {
    return action();
  } catch (const std::system_error& error) {
    fail_system(channel, name, error);
  }
}

[[noreturn]] void fail_locked(const std::string& channel, const std::string& name, Finding finding) {
  if (finding == Finding::kUsable || finding == Finding::kEmpty) {
    fail(channel, name, "another process writes this channel; a second instance of its node is refused",
         "stop the first instance ('fuser " + file_of(name) +
             "', package psmisc), or start this one in another namespace (__ns:=…)");
  }
  fail(channel, name, std::string("another process writes this channel, and its object ") + text(finding),
       "stop that process ('fuser " + file_of(name) + "', package psmisc): all nodes must be of one build");
}

void make(SharedMemory& object, const BusLayout& layout, MemoryMapping& mapping) {
  object.reserve(layout.object_bytes);
  mapping = object.map(layout.object_bytes);
  auto* head = static_cast<ChannelHead*>(mapping.data());
  head->layout_version = kLayoutVersion;
  head->frame_bytes = layout.frame_bytes;
  head->slots = layout.slots;
  head->magic.store(kChannelMagic, std::memory_order_release);
}

void take_over(SharedMemory& object, const BusLayout& layout, MemoryMapping& mapping) {
  mapping = object.map(layout.object_bytes);
  auto* head = static_cast<ChannelHead*>(mapping.data());
  head->attached_run.store(0, std::memory_order_relaxed);
  head->robot_hash.store(0, std::memory_order_release);
}

/// Readers of the old object map the new one as soon as the flag is set.
void retire(const SharedMemory& object) {
  const std::uint64_t retired = 1;
  object.write_at(offsetof(HeadStart, retired), &retired, sizeof retired);
}

std::optional<SharedMemory> open_or_create(const std::string& name) {
  std::optional<SharedMemory> object = SharedMemory::open(name, Access::kReadWrite);
  return object ? std::move(object) : SharedMemory::create(name);
}

/// False: another process held the lock for longer than kLockTries · kSettleNs, or the name has another object by now.
bool lock_soon(SharedMemory& object) {
  for (int tries = 0; !object.lock(); ++tries) {
    if (tries == kLockTries || !object.still_named()) return false;
    sleep_ns(kSettleNs);
  }
  return true;
}

OwnedBusObject claim_object(const std::string& channel, const std::string& name, const BusLayout& layout) {
  for (int tries = 0; tries < kClaimTries; ++tries) {
    std::optional<SharedMemory> object = open_or_create(name);
    if (!object) continue;
    if (!object->is_private()) fail_not_private(channel, name);
    const bool locked = lock_soon(*object);
    if (!object->still_named()) continue;
    const Finding finding = inspect(*object, layout);
    if (!locked) fail_locked(channel, name, finding);
    MemoryMapping mapping;
    if (finding == Finding::kUsable) {
      take_over(*object, layout, mapping);
      return {std::move(*object), std::move(mapping), false};
    }
    if (object->bytes() == 0) {
      try {
        make(*object, layout, mapping);
      } catch (const std::system_error&) {
        shm_unlink(name.c_str());
        throw;
      }
      return {std::move(*object), std::move(mapping), true};
    }
    if (finding == Finding::kOtherLayout) retire(*object);
    shm_unlink(name.c_str());
  }
  fail(channel, name, "the object changed at each attempt to lock it", "check which processes create and remove it");
}

}  // namespace

std::string bus_object_name(const std::string& bus, const std::string& channel) {
  std::string name = "/robot_control." + std::to_string(geteuid()) + "." + bus + "." + channel;
  const auto is_plain = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.'; };
  if (bus.empty() || channel.empty() || name.size() > NAME_MAX ||
      !std::all_of(name.begin() + 1, name.end(), is_plain)) {
    throw BusError("bus '" + bus + "', channel '" + channel +
                   "': must consist of letters, digits, '_', '-', '.', and be short enough for a file name; remedy: " +
                   "set another parameter 'bus'");
  }
  return name;
}

BusContent content_of(const SharedMemory& object, const BusLayout& layout) {
  switch (inspect(object, layout)) {
    case Finding::kUsable:
      return BusContent::kUsable;
    case Finding::kEmpty:
      return BusContent::kNone;
    default:
      return BusContent::kUnreadable;
  }
}

OwnedBusObject OwnedBusObject::claim(const std::string& bus, const std::string& channel, const BusLayout& layout) {
  const std::string name = bus_object_name(bus, channel);
  return reporting(channel, name, [&] { return claim_object(channel, name, layout); });
}

ForeignBusObject::ForeignBusObject(const std::string& bus, std::string channel, const BusLayout& layout)
    : channel_(std::move(channel)), name_(bus_object_name(bus, channel_)), layout_(layout) {}

bool ForeignBusObject::poll() {
  try {
    return map_newest();
  } catch (const std::system_error& error) {
    if (!is_shortage(error)) fail_system(channel_, name_, error);
    obstacle_ = "cannot be opened: too many open files";
    return false;
  }
}

bool ForeignBusObject::map_newest() {
  std::optional<SharedMemory> named = SharedMemory::open(name_, Access::kReadOnly);
  obstacle_ = named ? "" : "does not exist yet";
  if (!named || is_current(*named)) return false;
  if (!named->is_private()) fail_not_private(channel_, name_);
  obstacle_ = obstacle_of(*named);
  if (!obstacle_.empty()) return false;
  mappings_.push_back(named->map(layout_.object_bytes));
  object_ = std::move(named);
  data_.store(mappings_.back().data(), std::memory_order_release);
  return true;
}

/// A retired object is never current: the next call maps its successor.
bool ForeignBusObject::is_current(const SharedMemory& named) const {
  return object_ && object_->same_object(named) && inspect(named, layout_) == Finding::kUsable;
}

/// The reason why the object is not mapped; empty: it can be. The next writer replaces an unlocked
/// unusable object. A locked one stays unusable, which is an error.
std::string ForeignBusObject::obstacle_of(const SharedMemory& named) const {
  Finding finding = inspect(named, layout_);
  for (int tries = 0; tries < kSettleTries; ++tries) {
    if (finding == Finding::kUsable) return "";
    if (finding == Finding::kEmpty || finding == Finding::kRetired || !named.locked_elsewhere()) return text(finding);
    sleep_ns(kSettleNs);
    finding = inspect(named, layout_);
  }
  if (!named.still_named()) return text(finding);
  fail_locked(channel_, name_, finding);
}

}  // namespace robot_control
