#include "log/bag/bag_trials.h"

#include <ctime>
#include <random>

#include "log/bag/read_bag.h"

namespace robot_control {
namespace {

using Random = std::mt19937_64;

constexpr double kMaxSeconds = 2.0;  // s of processor time; a trial takes milliseconds, under a sanitizer some hundred

std::size_t below(Random& random, std::size_t end) {
  return end == 0 ? 0 : std::uniform_int_distribution<std::size_t>(0, end - 1)(random);
}

void overwrite_length(std::string& bytes, Random& random) {
  constexpr std::uint64_t kLengths[] = {0,      1,       3,       4,          12,         0xFF,
                                        0xFFFF, 0x10000, 0x10001, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF};
  const std::string length = little_endian(kLengths[below(random, std::size(kLengths))], 4);
  if (bytes.size() >= 4) bytes.replace(below(random, bytes.size() - 3), 4, length);
}

void exchange_records(std::string& bytes, const MadeBag& made, Random& random) {
  const auto [first, first_size] = made.records[below(random, made.records.size())];
  const auto [second, second_size] = made.records[below(random, made.records.size())];
  const std::string one = made.bytes.substr(first, first_size), other = made.bytes.substr(second, second_size);
  if (first < second) {
    bytes.replace(second, second_size, one);
    bytes.replace(first, first_size, other);
  } else {
    bytes.insert(second, one);  // repeated
  }
}

std::string foreign(Random& random) {
  std::string bytes = below(random, 2) == 0 ? "#ROSBAG V2.0\n" : "";
  const std::size_t size = below(random, 3000);
  while (bytes.size() < size) bytes += static_cast<char>(below(random, 4) == 0 ? below(random, 256) : below(random, 8));
  return bytes;
}

std::string damaged(const MadeBag& made, Random& random) {
  std::string bytes = made.bytes;
  switch (below(random, 8)) {
    case 0:
      for (std::size_t i = below(random, 20) + 1; i > 0; --i) {
        char& byte = bytes[below(random, bytes.size())];
        byte = static_cast<char>(byte ^ (1 << below(random, 8)));
      }
      break;
    case 1: {  // change between the data: lengths, fields
      const auto [begin, size] = made.records[below(random, made.records.size())];
      char& byte = bytes[begin + below(random, std::min<std::size_t>(size, 70))];
      byte = static_cast<char>(byte ^ (1 << below(random, 8)));
      break;
    }
    case 2:
      overwrite_length(bytes, random);
      break;
    case 3:
      bytes.erase(below(random, bytes.size()), below(random, 200) + 1);
      break;
    case 4:
      bytes.insert(below(random, bytes.size()),
                   std::string(below(random, 200) + 1, static_cast<char>(below(random, 256))));
      break;
    case 5:
      exchange_records(bytes, made, random);
      break;
    case 6:
      bytes.resize(below(random, bytes.size()));
      if (below(random, 2) == 0) overwrite_length(bytes, random);
      break;
    default:
      bytes = foreign(random);
  }
  return bytes;
}

/// "" or the difference between a message that was read and the one that was written.
std::string difference(const MadeMessage& read, const MadeMessage& written) {
  if (read.connection != written.connection) return "its connection";
  if (read.time_ns != written.time_ns) return "its time";
  if (read.data.size() != written.data.size()) return "its length";
  return read.data == written.data ? "" : "its content";
}

using Chunks = std::vector<std::vector<MadeMessage>>;

/// The first error of the bag; `early` holds the chunks that were read while the bag was checked.
std::string wrong_in(BagReader& bag, const Chunks& early, const MadeBag& made) {
  const Chunks chunks = read_all(bag);
  if (early != chunks) return "what was read while it was checked is something else";
  const bool whole = bag.cut().empty();
  if (chunks.size() > made.chunks.size()) return "there are more chunks";
  if (whole && chunks.size() < made.chunks.size()) return "there are less chunks";
  for (std::size_t i = 0; i < chunks.size(); ++i) {
    if (chunks[i].size() != made.chunks[i].size()) return "chunk " + std::to_string(i) + " has another length";
    for (std::size_t k = 0; k < chunks[i].size(); ++k) {
      const std::string wrong = difference(chunks[i][k], made.chunks[i][k]);
      if (!wrong.empty()) return "of message " + std::to_string(k) + " of chunk " + std::to_string(i) + " " + wrong;
    }
  }
  for (const auto& [number, connection] : bag.connections()) {
    if (number > 1 || connection.topic != (number == 0 ? "/odom" : "/imu")) {
      if (whole) return "a connection is another";
    }
  }
  return "";
}

double processor_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace

std::optional<std::string> bag_violation(std::uint64_t seed, BagFigures& figures) {
  Random random(seed);
  const bool unfinished = below(random, 4) == 0;
  const MadeBag made = make_bag(2 + below(random, 4), 2 + below(random, 60), {.unfinished = unfinished});
  const BagOfBytes file(damaged(made, random));
  const double begin = processor_seconds();
  std::string wrong;
  try {
    Chunks early;
    BagReader bag(file.path(),
                  [&](BagReader& half, const BagChunk& chunk) { early.push_back(read_chunk(half, chunk)); });
    ++(bag.cut().empty() ? figures.whole : figures.cut);
    wrong = wrong_in(bag, early, made);
  } catch (const BagError& error) {
    ++figures.refused;
    const std::string text = error.what();
    if (!text.starts_with("byte ") || text.find(", field ") == std::string::npos || text.size() > 600) wrong = text;
  }
  const double seconds = processor_seconds() - begin;
  if (seconds > kMaxSeconds) wrong = "it took " + std::to_string(seconds) + " s of processor time";
  return wrong.empty() ? std::nullopt : std::optional(wrong);
}

}  // namespace robot_control
