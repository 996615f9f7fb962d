#pragma once
/// Reads a bag from bytes in memory.

#include <sys/mman.h>
#include <unistd.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "log/bag/bag_reader.h"
#include "log/bag/made_bag.h"
#include "support/message_of.h"

namespace robot_control {

/// A file in memory, with a name to open it by.
class BagOfBytes {
 public:
  explicit BagOfBytes(const std::string& bytes) : descriptor_(memfd_create("bag", MFD_CLOEXEC)) {
    if (write(descriptor_, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size())) {
      throw std::runtime_error("the file in memory could not be written");
    }
  }
  ~BagOfBytes() { close(descriptor_); }
  BagOfBytes(const BagOfBytes&) = delete;
  BagOfBytes& operator=(const BagOfBytes&) = delete;

  std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }
  void shorten(std::size_t size) const {
    if (ftruncate(descriptor_, static_cast<off_t>(size)) != 0) throw std::runtime_error("ftruncate");
  }

 private:
  int descriptor_;
};

inline std::vector<MadeMessage> read_chunk(BagReader& bag, const BagChunk& chunk) {
  std::vector<MadeMessage> messages;
  bag.read(chunk, [&](const BagMessage& message) {
    messages.push_back({message.connection, message.time_ns, std::string(message.data)});
  });
  return messages;
}

inline std::vector<std::vector<MadeMessage>> read_all(BagReader& bag) {
  std::vector<std::vector<MadeMessage>> chunks;
  for (const BagChunk& chunk : bag.chunks()) chunks.push_back(read_chunk(bag, chunk));
  return chunks;
}

/// The message of the refusal; empty if the bag is accepted.
inline std::string refusal(const std::string& bytes) {
  const BagOfBytes file(bytes);
  return message_of<BagError>([&] { const BagReader bag(file.path()); });
}

}  // namespace robot_control
