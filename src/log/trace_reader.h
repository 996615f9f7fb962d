#pragma once
/// Reads header, rows and snapshots of a log, run.bag. The whole file is checked (log/bag/bag_reader.h). If its writer
/// was killed, it is read up to its last whole chunk.

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "log/bag/bag_reader.h"
#include "log/messages/log_messages.h"
#include "log/messages/trace_message.h"

namespace robot_control {

class TraceReader {
 public:
  /// These functions receive the contents of the log; each may be empty.
  struct Use {
    std::function<void(const LogHeader&)> header = {};  ///< before the first row
    std::function<void(const TraceRow&, std::int64_t ros_time_ns)> row = {};
    std::function<void(const TraceRow&, const BagMessage&)> message = {};  ///< receives the same row, and its bytes
    std::function<void(const LawSnapshot&, std::int64_t ros_time_ns)> snapshot = {};
    std::function<void(double share)> chunk = {};  ///< receives the share of the file that is read, after each chunk
    std::function<void()> damaged = {};            ///< BagReader::Damaged
  };

  /// Throws BagError for a damaged bag, NoTraceError for another bag, TraceError for a header that breaks its rules,
  /// std::runtime_error for an unreadable file.
  explicit TraceReader(const std::string& path) : TraceReader(path, {}) {}

  /// This constructor also gives everything to `use` while the file is checked; a `read` afterwards would double the
  /// time. If it throws, the caller must drop everything that `use` received.
  TraceReader(const std::string& path, const Use& use);

  const LogHeader& header() const noexcept { return *header_; }

  /// True: the fields of its rows are those of this version, in their order.
  bool of_this_version() const;

  /// Gives everything to `use` in the order of the file. Throws TraceError for a message that breaks its definition.
  void read(const Use& use);

  /// The text names the part of the file that is read, and the reason; it is empty for a whole file.
  const std::string& cut() const { return bag_.cut(); }

 private:
  void find_header(BagReader& bag, const BagChunk& chunk);
  void find_connections(const BagReader& bag, const Use& use);
  void read_chunk(BagReader& bag, const BagChunk& chunk, const Use& use);

  std::string path_;
  std::optional<LogHeader> header_;
  std::map<std::uint32_t, TraceDecoder> rows_;  ///< decoders by connection
  std::set<std::uint32_t> snapshots_;           ///< connections of snapshots
  BagReader bag_;                               ///< stands last, because its constructor uses the other members
};

}  // namespace robot_control
