#include "bus/bus_cleanup.h"

#include <sys/mman.h>
#include <unistd.h>

#include <filesystem>
#include <map>
#include <optional>
#include <system_error>
#include <utility>

#include "bus/bus.h"
#include "bus/bus_object.h"
#include "bus/latest_frames.h"
#include "rt/shared_memory.h"
#include "signals/command_frame.h"
#include "signals/permit.h"

namespace robot_control {
namespace {

/// Names of channels by bus. A bus may have dots in its name, a channel has none.
std::map<std::string, std::vector<std::string>> channels_by_bus() {
  std::map<std::string, std::vector<std::string>> found;
  const std::string prefix = "robot_control." + std::to_string(geteuid()) + ".";
  std::error_code error;
  for (std::filesystem::directory_iterator entry("/dev/shm", error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename();
    const std::size_t dot = name.rfind('.');
    if (!name.starts_with(prefix) || dot < prefix.size()) continue;
    found[name.substr(prefix.size(), dot - prefix.size())].push_back(name.substr(dot + 1));
  }
  return found;
}

struct LockedObject {
  std::string channel;
  std::string name;
  SharedMemory object;
};

/// All of them, or none.
std::vector<LockedObject> locked(const std::string& bus, const std::vector<std::string>& channels) {
  std::vector<LockedObject> objects;
  for (const std::string& channel : channels) {
    const std::string name = bus_object_name(bus, channel);
    std::optional<SharedMemory> object = SharedMemory::open(name, Access::kReadWrite);
    if (!object || !object->is_private() || !object->lock() || !object->still_named()) return {};
    objects.push_back({channel, name, std::move(*object)});
  }
  return objects;
}

/// Returns kCorrupt if the last frame was torn by a death, and nothing if the object is no channel of such frames.
template <class Frame>
std::optional<Lookup> last_frame(const SharedMemory& object, Frame& out) {
  constexpr BusLayout kLayout = BusLayoutOf<LatestFrames<Frame>>::value;
  const BusContent content = content_of(object, kLayout);
  if (content == BusContent::kUnreadable) return std::nullopt;
  if (content != BusContent::kUsable) return Lookup::kMissing;
  const MemoryMapping mapping = object.map(kLayout.object_bytes);
  const auto* frames = static_cast<const LatestFrames<Frame>*>(mapping.data());
  const Lookup found = FrameReader<Frame>(frames).newest(out);
  return found == Lookup::kMissing && frames->newest.load() != 0 ? Lookup::kCorrupt : found;
}

bool latched(const SharedMemory& permits) {
  Permit last;
  const auto found = last_frame(permits, last);
  return found == Lookup::kFrame ? last.causes != 0 : found != Lookup::kMissing;
}

/// The start of another layout does not read such a channel, so that one counts as empty.
bool requests_motion(const SharedMemory& commands) {
  CommandFrame last;
  const auto found = last_frame(commands, last);
  return found == Lookup::kFrame ? requests_motion(last) : found && found != Lookup::kMissing;
}

bool remove_bus(const std::string& bus, const std::vector<std::string>& channels) {
  const std::vector<LockedObject> objects = locked(bus, channels);
  for (const LockedObject& each : objects) {
    if (each.channel == ChannelNames::kPermit && latched(each.object)) return false;
  }
  bool removed = false;
  for (const LockedObject& each : objects) {
    if (each.channel == ChannelNames::kCommand && requests_motion(each.object)) continue;
    removed |= shm_unlink(each.name.c_str()) == 0;
  }
  return removed;
}

}  // namespace

std::vector<std::string> remove_ended_buses(const std::string& own) {
  std::vector<std::string> removed;
  for (const auto& [bus, channels] : channels_by_bus()) {
    if (bus == own) continue;
    try {
      if (remove_bus(bus, channels)) removed.push_back(bus);
    } catch (const std::exception&) {
      continue;  // another user's, or gone meanwhile
    }
  }
  return removed;
}

}  // namespace robot_control
