#include "log/trace_reader.h"

#include <algorithm>

#include "log/messages/message_types.h"

namespace robot_control {
TraceReader::TraceReader(const std::string& path, const Use& use)
    : path_(path),
      bag_(
          path,
          [&](BagReader& bag, const BagChunk& chunk) {
            if (bag.chunks().size() == 1) find_header(bag, chunk);
            if (!header_) return;
            if (bag.chunks().size() == 1 && use.header) use.header(*header_);
            read_chunk(bag, chunk, use);
          },
          use.damaged) {
  if (!header_) {
    throw NoTraceError(path + " is not a log of robot_control: it does not begin with a TraceHeader" +
                       (cut().empty() ? "" : "; " + cut()));
  }
}

void TraceReader::find_header(BagReader& bag, const BagChunk& chunk) {
  for (const auto& [number, connection] : bag.connections()) {
    if (connection.type != trace_header_type().name) continue;
    bag.read(chunk, [&, wanted = number, &definition = connection.definition](const BagMessage& message) {
      if (message.connection == wanted && !header_) header_ = decode_header(message.data, definition);
    });
  }
}

void TraceReader::find_connections(const BagReader& bag, const Use& use) {
  for (const auto& [number, connection] : bag.connections()) {
    if ((use.row || use.message) && connection.type == trace_type().name && !rows_.contains(number)) {
      rows_.emplace(number, connection.definition);
    }
    if (!use.snapshot || connection.type != snapshot_type().name || !snapshots_.insert(number).second) continue;
    if (connection.md5sum != snapshot_type().md5) {
      throw TraceError(path_ + ": its " + connection.type + " has a different layout than this version (" +
                       package_version() + "): version " + header_->version + ", build " + header_->build +
                       " wrote it; replay with that build");
    }
  }
}

void TraceReader::read_chunk(BagReader& bag, const BagChunk& chunk, const Use& use) {
  if (use.row || use.message || use.snapshot) {
    find_connections(bag, use);
    TraceRow row;
    try {
      bag.read(chunk, [&](const BagMessage& message) {
        const auto decoder = rows_.find(message.connection);
        if (decoder != rows_.end() && (use.row || use.message)) {
          decoder->second.decode(message.data, row);
          if (use.row) use.row(row, static_cast<std::int64_t>(message.time_ns));
          if (use.message) use.message(row, message);
        } else if (use.snapshot && snapshots_.contains(message.connection)) {
          use.snapshot(decode_snapshot(message.data), static_cast<std::int64_t>(message.time_ns));
        }
      });
    } catch (const TraceError& error) {
      throw TraceError(path_ + ", chunk at byte " + std::to_string(chunk.record) + ": " + error.what());
    }
  }
  const std::uint64_t end = chunk.begin + chunk.packed;
  if (use.chunk) use.chunk(static_cast<double>(end) / static_cast<double>(bag.size()));
}

bool TraceReader::of_this_version() const {
  return std::ranges::all_of(bag_.connections(), [](const auto& each) {
    const BagConnection& connection = each.second;
    return connection.type != trace_type().name || TraceDecoder(connection.definition).of_this_version();
  });
}

void TraceReader::read(const Use& use) {
  if (use.header) use.header(*header_);
  for (const BagChunk& chunk : bag_.chunks()) read_chunk(bag_, chunk, use);
}

}  // namespace robot_control
