/// The messages of a log beside its rows reveal any changed byte.

#include <gtest/gtest.h>

#include "log/messages/log_messages.h"
#include "log/messages/message_types.h"
#include "log/messages/trace_message.h"
#include "loop/log_header.h"
#include "recorded_drive.h"
#include "support/recorded_loop.h"

namespace robot_control::tests {

/// Changes each byte of the message: it must be refused or not intact. Names the byte that is not detected.
template <class Decode>
void expect_every_change_is_noticed(const std::string& message, std::size_t step, Decode decode) {
  EXPECT_TRUE(intact(decode(message)));
  for (std::size_t at = 0; at < message.size(); at += step) {
    std::string changed = message;
    changed[at] = static_cast<char>(changed[at] ^ 1);
    try {
      EXPECT_FALSE(intact(decode(changed))) << "byte " << at;
    } catch (const TraceError&) {
    }
  }
}

TEST(SealedMessages, ShowEveryChangeOfAHeader) {
  const Parameters parameters = drive_parameters();
  const ClosedLoop loop(parameters);
  LogHeader header = log_header(parameters, loop.robot());
  header.parameters.resize(100);  // for speed; so are the other two
  header.urdf.resize(100);
  header.scene.resize(100);
  expect_every_change_is_noticed(encode(header), 1, [](const std::string& message) {
    return decode_header(message, trace_header_type().definition);
  });
}

TEST(SealedMessages, ShowEveryChangeOfASnapshot) {
  RecordedLoop loop(drive_parameters());
  loop.step();
  for (const LawSnapshot* snapshot : loop.snapshots()) {
    ASSERT_NE(snapshot, nullptr);
    LawSnapshot sealed = *snapshot;
    seal(sealed);
    expect_every_change_is_noticed(encode(sealed), 37,
                                   [](const std::string& message) { return decode_snapshot(message); });
  }
}

}  // namespace robot_control::tests
