/// A log whose messages have another layout is refused with the version that wrote it and the remedy.

#include "log/bag_writer.h"
#include "log/messages/log_messages.h"
#include "log/messages/trace_message.h"
#include "log/trace_reader.h"
#include "support/matchers.h"
#include "support/message_of.h"
#include "support/temporary_folder.h"

namespace robot_control::tests {

/// A bag of a header of version 0.3.0, and of one message of `type`.
std::string bag_with(const TemporaryFolder& folder, MessageType type, const std::string& message) {
  const std::string path = folder.path() / "run.bag";
  const std::vector<WrittenConnection> connections{{.topic = "trace_header", .type = trace_header_type()},
                                                   {.topic = "other", .type = std::move(type)}};
  BagWriter writer(path, connections, [](std::int64_t) { return true; });
  ChunkBuilder chunk;
  chunk.add_record(connection_records(connections));
  chunk.add(0, 1, encode(LogHeader{.period = 0.001, .clock = "wall", .version = "0.3.0", .build = "gcc 9"}));
  chunk.add(1, 1, message);
  writer.write(chunk.pack(Effort::kThorough));
  writer.close();
  return path;
}

TEST(ALogOfAnotherLayout, IsRefusedWithTheVersionOfItsSnapshotsAndTheRemedy) {
  const TemporaryFolder folder;
  MessageType other = snapshot_type();
  other.md5.front() = other.md5.front() == '0' ? '1' : '0';
  const std::string path = bag_with(folder, other, encode(LawSnapshot{}));
  TraceReader reader(path);
  const std::string message =
      message_of<TraceError>([&] { reader.read({.snapshot = [](const LawSnapshot&, std::int64_t) {}}); });
  for (const std::string& part : {path, package_version(), std::string("version 0.3.0, build gcc 9 wrote it"),
                                  std::string("replay with that build")}) {
    EXPECT_THAT(message, HasSubstr(part));
  }
}

TEST(ALogOfAnotherLayout, HasRowsOfAnotherVersion) {
  const TemporaryFolder folder;
  MessageType other = trace_type();
  EXPECT_TRUE(TraceReader(bag_with(folder, other, "")).of_this_version());
  other.definition = "uint64 of_another_version\n" + other.definition;
  EXPECT_FALSE(TraceReader(bag_with(folder, other, "")).of_this_version());
}

}  // namespace robot_control::tests
