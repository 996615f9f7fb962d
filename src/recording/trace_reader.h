#pragma once
/// A log, run.bag, row by row: header, rows, snapshots. The whole file is checked (bags/bag_reader.h); one whose writer
/// was killed is read to its last whole chunk.

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "bags/bag_reader.h"
#include "recording/log_messages.h"
#include "recording/message_types.h"
#include "recording/trace_message.h"

namespace robot_control {

class TraceReader {
 public:
  /// What gets what is read; each may be empty.
  struct Use {
    std::function<void(const LogHeader&)> header = {};  ///< before the first row
    std::function<void(const TraceRow&, std::int64_t ros_time_ns)> row = {};
    std::function<void(const TraceRow&, const BagMessage&)> message = {};  ///< the same row, and its bytes
    std::function<void(const LawSnapshot&)> snapshot = {};
    std::function<void(double share)> chunk = {};  ///< after each: the share of the file that is read
  };

  /// Throws BagError: no sound bag; TraceError: no log; std::runtime_error: no file to read.
  explicit TraceReader(const std::string& path) : TraceReader(path, {}) {}

  /// The same, and gives everything to `use` while the file is checked, in half of the time that a `read` afterwards
  /// takes. Where it throws, what `use` got is to be dropped.
  TraceReader(const std::string& path, const Use& use);

  const LogHeader& header() const noexcept { return *header_; }

  /// Are the fields of its rows those of this version, in their order?
  bool of_this_version() const;

  /// Everything in the order of the file. Throws TraceError for a message that is not as its definition says.
  void read(const Use& use);

  /// Which part of the file is read, and why not all of it; empty: it is whole.
  const std::string& cut() const { return bag_.cut(); }

 private:
  void find_header(BagReader& bag, const BagChunk& chunk);
  void look_at_connections(const BagReader& bag, const Use& use);
  void take(BagReader& bag, const BagChunk& chunk, const Use& use);

  std::string path_;
  std::optional<LogHeader> header_;
  std::map<std::uint32_t, TraceDecoder> rows_;  ///< by connection
  std::set<std::uint32_t> snapshots_;           ///< connections
  BagReader bag_;                               ///< last: while it is made, it uses the others
};

}  // namespace robot_control
