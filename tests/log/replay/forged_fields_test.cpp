/// Every field of the message Trace is edited in random rows, and a replay notices it. An edit whose author renews the
/// checksum of the message may escape. The page docs/log.md lists the fields with such edits, and this test reads the
/// list.

#include <algorithm>
#include <fstream>
#include <random>

#include "files/input_file.h"
#include "log/messages/message_checksum.h"
#include "log/replay/recorded.h"
#include "support/matchers.h"
#include "support/recorded_loop.h"

namespace robot_control::tests {

/// A drive with two runs, live tuning, faults of the nodes' outputs, a request that wheels refuse, and a stop.
struct LoggedDrive {
  LoggedDrive() {
    constexpr std::uint64_t kCycles = 320;
    for (std::uint64_t k = 0; k < kCycles; ++k) {
      if (k % 50 == 20) loop.command({.linear = {0.4, 0, 0}, .angular = {0, 0, 0.3}});
      if (k == 40) loop.request({.joints = {0.1, 0.2}});
      if (k == 60) loop.reset();
      if (k == 120) loop.set_parameters("{max_linear_speed: 0.3}");
      if (k == 140) loop.inject_fault("estimator", "delayed");
      if (k == 150) loop.inject_fault("estimator", "ok");
      if (k == 170) loop.inject_fault("controller", "wrong");
      if (k == 174) loop.inject_fault("controller", "ok");
      if (k == 230) loop.e_stop();
      loop.step();
      for (const LawSnapshot* snapshot : loop.snapshots()) {
        if (snapshot == nullptr) continue;
        snapshots.push_back(*snapshot);
        seal(snapshots.back());
      }
      log(loop.row(), loop.robot().machine().joints.size(), messages);
    }
  }

  ReplayReport replay(const std::vector<LoggedMessage>& edited) const {
    return robot_control::replay(edited, snapshots, loop.robot(), parameters.loop.period());
  }

  /// True if something differs, was not compared, or cannot be read.
  bool notices(const std::vector<LoggedMessage>& edited) const {
    try {
      const ReplayReport report = replay(edited);
      return !report.exact() || std::ranges::any_of(report.laws, [](const LawReport& law) { return law.not_compared; });
    } catch (const TraceError&) {
      return true;
    }
  }

  Parameters parameters = default_parameters();
  RecordedLoop loop{parameters};
  std::vector<LawSnapshot> snapshots;
  std::vector<LoggedMessage> messages;
};

/// The bytes of a field's elements in a message.
struct Place {
  std::size_t message = 0;
  std::size_t begin = 0, end = 0;
};

/// The places of its elements, by field.
std::vector<std::vector<Place>> places_in(const std::vector<LoggedMessage>& log) {
  std::vector<std::vector<Place>> all(trace_fields().size());
  TraceRow passed_over;
  for (std::size_t i = 0; i < log.size(); ++i) {
    ByteSource from(log[i].bytes);
    const auto at = [&] { return log[i].bytes.size() - from.left(); };
    for (std::size_t field = 0; field < all.size(); ++field) {
      const std::size_t length = trace_fields()[field].type.ends_with("[]") ? sizeof(std::uint32_t) : 0;
      const std::size_t begin = at() + length;
      trace_fields()[field].read(from, passed_over);
      if (at() > begin) all[field].push_back({.message = i, .begin = begin, .end = at()});
    }
  }
  return all;
}

/// Renews the checksum of a message whose fields before the last one were changed.
void renew_checksum(LoggedMessage& message) {
  const std::size_t end = message.bytes.size() - sizeof(std::uint32_t);
  const std::uint32_t sum = message_checksum(std::string_view(message.bytes).substr(0, end), message.time_ns);
  message.bytes.replace(end, sizeof sum, reinterpret_cast<const char*>(&sum), sizeof sum);
}

/// The fields in the tables of docs/log.md below "What a replay cannot know".
std::set<std::string> fields_that_cannot_be_known() {
  std::ifstream page(std::string(PROJECT_DIRECTORY) + "/docs/log.md");
  std::set<std::string> fields;
  bool here = false;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("## ")) here = line == "## What a replay cannot know";
    if (!here || !line.starts_with("| `")) continue;
    const std::string cell = line.substr(0, line.find('|', 1));
    for (std::size_t begin = cell.find('`'); begin != std::string::npos;) {
      const std::size_t end = cell.find('`', begin + 1);
      fields.insert(cell.substr(begin + 1, end - begin - 1));
      begin = cell.find('`', end + 1);
    }
  }
  return fields;
}

struct ForgedFields : testing::Test {
  static const LoggedDrive& drive() {
    static const LoggedDrive drive;
    return drive;
  }

  /// Flips a random bit of a random element of the field in a random row; returns whether that is noticed.
  bool notices_edit(const std::vector<Place>& places, bool renewed) {
    std::vector<LoggedMessage> log = drive().messages;
    const Place& place = places[random_() % places.size()];
    LoggedMessage& message = log[place.message];
    char& byte = message.bytes[place.begin + random_() % (place.end - place.begin)];
    byte = static_cast<char>(byte ^ (1 << random_() % 8));
    if (renewed) renew_checksum(message);
    return drive().notices(log);
  }

  const std::vector<std::vector<Place>> places_ = places_in(drive().messages);
  std::mt19937_64 random_{26};
};

TEST_F(ForgedFields, AreNoneInTheLogAsItWasWritten) {
  const ReplayReport report = drive().replay(drive().messages);
  EXPECT_TRUE(report.exact()) << text_of(report);
  EXPECT_EQ(report.rows, drive().messages.size());
  EXPECT_TRUE(report.gaps.empty()) << text_of(report);
}

/// The parameter is the number of edits of each field.
class EditsOfForgedFields : public ForgedFields, public testing::WithParamInterface<int> {};
INSTANTIATE_TEST_SUITE_P(EveryDay, EditsOfForgedFields, testing::Values(1));
INSTANTIATE_TEST_SUITE_P(Nightly, EditsOfForgedFields, testing::Values(5));

TEST_P(EditsOfForgedFields, AreNoticedForEveryName) {
  for (std::size_t field = 0; field < places_.size(); ++field) {
    const std::string& name = trace_fields()[field].name;
    ASSERT_FALSE(places_[field].empty()) << name << " has no element in this drive";
    for (int i = 0; i < GetParam(); ++i) EXPECT_TRUE(notices_edit(places_[field], false)) << name;
  }
}

TEST_P(EditsOfForgedFields, AreNoticedOrDocumentedWithARenewedChecksum) {
  constexpr int kTries = 1000;  // few rows have neither a usable command nor permit
  std::set<std::string> listed = fields_that_cannot_be_known();
  EXPECT_FALSE(listed.empty());
  for (std::size_t field = 0; field < places_.size(); ++field) {
    const std::string& name = trace_fields()[field].name;
    const bool known = listed.erase(name) == 0;
    bool noticed = true;
    for (int i = 0; noticed && i < (known ? GetParam() : kTries); ++i) noticed = notices_edit(places_[field], true);
    EXPECT_EQ(noticed, known) << name << (known ? " is not listed" : " is listed, but every edit is noticed");
  }
  EXPECT_THAT(listed, IsEmpty()) << "no such fields";
}

}  // namespace robot_control::tests
