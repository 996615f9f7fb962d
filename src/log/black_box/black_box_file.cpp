#include "log/black_box/black_box_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstring>

#include "log/black_box/black_box_layout.h"

namespace robot_control {

using namespace black_box_layout;

BlackBoxFile::BlackBoxFile(const std::string& path, std::size_t bytes, std::string_view description)
    : path_(path), segments_((bytes + kSegmentBytes - 1) / kSegmentBytes + 1) {
  head_bytes_ = (sizeof(Head) + description.size() + kSegmentBytes - 1) / kSegmentBytes * kSegmentBytes;
  size_ = head_bytes_ + segments_ * kSegmentBytes;
  descriptor_ = open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (descriptor_ < 0) fail(path, std::strerror(errno));
  flock(descriptor_, LOCK_EX | LOCK_NB);
  const int reserved = posix_fallocate(descriptor_, 0, static_cast<off_t>(size_));
  void* memory = reserved == 0 ? mmap(nullptr, size_, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor_, 0) : MAP_FAILED;
  const int problem = reserved != 0 ? reserved : errno;
  if (memory == MAP_FAILED) {
    close(descriptor_);
    unlink(path.c_str());
    fail(path, std::string(reserved != 0 ? "there is no room for" : "there is no memory to map") +
                   " the black box of " + std::to_string(size_ / 1'000'000) + " MB: " + std::strerror(problem) +
                   "; make room, or set telemetry.black_box to 0 or telemetry.directory");
  }
  // A process that locks its memory (rt/realtime_thread.h) has made the whole ring present and must not keep it so.
  munlock(memory, size_);
  memory_ = static_cast<char*>(memory);
  give_back(0, size_);
  Head head{.magic = {},
            .head_bytes = head_bytes_,
            .segments = segments_,
            .description_bytes = description.size(),
            .checksum = 0,
            .ended = 0};
  head.checksum = checksum_of(head, description);
  std::memcpy(head.magic, kMagic, sizeof kMagic);
  std::memcpy(memory_ + sizeof head, description.data(), description.size());
  std::memcpy(memory_, &head, sizeof head);
}

BlackBoxFile::~BlackBoxFile() {
  munmap(memory_, size_);
  close(descriptor_);
}

void BlackBoxFile::give_back(std::size_t begin, std::size_t bytes) noexcept {
  madvise(memory_ + begin, bytes, MADV_DONTNEED);
}

bool BlackBoxFile::at_its_path() const noexcept {
  struct stat own {};
  struct stat present {};
  return fstat(descriptor_, &own) == 0 && stat(path_.c_str(), &present) == 0 && own.st_ino == present.st_ino &&
         own.st_dev == present.st_dev;
}

void BlackBoxFile::mark_ended() noexcept {
  const std::uint64_t ended = 1;
  std::memcpy(memory_ + offsetof(Head, ended), &ended, sizeof ended);
}

bool BlackBoxFile::append(std::uint32_t kind, std::int64_t time_ns, std::string_view data) noexcept {
  const std::size_t size = sizeof(RecordHead) + padded(data.size());
  if (size > kSegmentBytes) return false;
  if (at_ + size > kSegmentBytes) {
    give_back(head_bytes_ + (sequence_ % segments_) * kSegmentBytes, kSegmentBytes);
    ++sequence_;
    at_ = 0;
  }
  RecordHead head{
      .sequence = sequence_, .time_ns = time_ns, .kind = kind, .length = static_cast<std::uint32_t>(data.size())};
  head.checksum = checksum_of(head, data);
  char* const place = memory_ + head_bytes_ + (sequence_ % segments_) * kSegmentBytes + at_;
  std::memcpy(place + sizeof head, data.data(), data.size());
  std::memcpy(place, &head, sizeof head);
  at_ += size;
  return true;
}

}  // namespace robot_control
