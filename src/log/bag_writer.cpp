#include "log/bag_writer.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>

#include "files/given_path.h"
#include "log/log_error.h"

namespace robot_control {
namespace {

// The first record is padded to this length, so that it can be replaced in place; rosbag does the same.
constexpr std::size_t kHeaderBytes = 4096;

std::string connection_record(std::uint32_t number, const WrittenConnection& connection) {
  BagFields data(BagOp::kConnection);
  const std::size_t op = data.bytes().size();  // the data has no field `op`
  data.text("topic", connection.topic).text("type", connection.type.name).text("md5sum", connection.type.md5);
  data.text("message_definition", connection.type.definition);
  if (connection.latching) data.text("latching", "1");
  BagFields fields(BagOp::kConnection);
  fields.number("conn", number).text("topic", connection.topic);
  std::string record;
  append_record(record, fields, std::string_view(data.bytes()).substr(op));
  return record;
}

}  // namespace

std::string bag_opening(std::uint64_t index_position, std::size_t connections, std::uint32_t chunks) {
  BagFields fields(BagOp::kBagHeader);
  fields.number("index_pos", index_position);
  fields.number("conn_count", static_cast<std::uint32_t>(connections)).number("chunk_count", chunks);
  std::string bytes(kBagMagic);
  append_record(bytes, fields, std::string(kHeaderBytes - fields.bytes().size(), ' '));
  return bytes;
}

std::string connection_records(const std::vector<WrittenConnection>& connections) {
  std::string bytes;
  for (std::uint32_t i = 0; i < connections.size(); ++i) bytes += connection_record(i, connections[i]);
  return bytes;
}

BagWriter::BagWriter(std::string path, std::vector<WrittenConnection> connections, LogFile::Room room)
    : file_(std::move(path), std::move(room)), connections_(std::move(connections)) {
  file_.append(bag_opening(0, connections_.size(), 0));
}

BagWriter::~BagWriter() {
  try {
    close();
  } catch (const LogError&) {
    // A caller that needs to know the result has called close().
  }
}

void BagWriter::write(const PackedChunk& chunk) {
  if (!open()) return;
  file_.check_presence();
  BagFields fields(BagOp::kChunkInfo);
  fields.number("ver", std::uint32_t{1}).number("chunk_pos", static_cast<std::uint64_t>(bytes()));
  fields.time("start_time", chunk.begin_ns).time("end_time", chunk.end_ns);
  fields.number("count", static_cast<std::uint32_t>(chunk.count.size()));
  std::string counts;
  ByteSink sink(counts);
  for (const auto& [connection, count] : chunk.count) {
    sink.number(connection);
    sink.number(count);
  }
  file_.append(chunk.record + chunk.index);
  append_record(chunk_infos_, fields, counts);
  ++chunks_;
}

void BagWriter::close() {
  if (!open()) return;
  const auto index_position = static_cast<std::uint64_t>(bytes());
  file_.append(connection_records(connections_) + chunk_infos_);
  file_.replace_begin(bag_opening(index_position, connections_.size(), chunks_));
  file_.close();
}

LogFile::LogFile(std::string path, Room room) : path_(std::move(path)), room_(std::move(room)) {
  const std::filesystem::path folder = std::filesystem::path(path_).parent_path();
  std::error_code error;
  if (!folder.empty()) std::filesystem::create_directories(folder, error);
  if (error) fail(failed("written", error.value()), error.value());
  file_ = Descriptor(::open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644));
  if (!file_.open()) fail(failed("written", errno), errno);
}

void LogFile::check_presence() {
  if (const int absence = file_.absence_from(path_); absence != 0) fail("was removed while it was written", absence);
}

void LogFile::append(std::string_view part) {
  if (room_ && !room_(bytes_ + static_cast<std::int64_t>(part.size()))) {
    file_.close();
    throw LogError(
        "log " + path_ +
        " has ended: telemetry.quota is reached, and no older log can be removed. The next log starts in 10 s; "
        "then this one may be removed. Set a larger telemetry.quota, or remove files");
  }
  const int error = file_.write(part);
  if (error == 0) {
    bytes_ += static_cast<std::int64_t>(part.size());
    return;
  }
  // A reader would misunderstand an incomplete part. A pipe cannot be cut and need not be.
  [[maybe_unused]] const int cut = ::ftruncate(file_.number(), bytes_);
  fail(failed("written", error), error);
}

void LogFile::replace_begin(std::string_view bytes) {
  if (const int error = file_.write(bytes, 0); error != 0) fail(failed("completed", error), error);
}

void LogFile::close() {
  // Pipes and devices have nothing to synchronise.
  if (::fsync(file_.number()) != 0 && errno != EINVAL && errno != EROFS) fail(failed("completed", errno), errno);
  if (file_.close() != 0) fail(failed("closed", errno), errno);
}

void LogFile::fail(const std::string& why, int error) {
  file_.close();
  const bool full = error == ENOSPC || error == EDQUOT || error == EFBIG;
  throw LogError("log " + file_error(path_, why) +
                 (full ? "; remove files or set another folder" : "; set a folder that can be written") +
                 " (telemetry.directory)");
}

}  // namespace robot_control
