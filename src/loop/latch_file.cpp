#include "loop/latch_file.h"

#include <array>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <optional>
#include <sstream>
#include <system_error>

#include "files/input_file.h"
#include "files/output_file.h"
#include "machine/model_hash.h"
#include "rt/clock.h"
#include "signals/checksum.h"
#include "signals/names.h"

namespace robot_control {
namespace {

constexpr std::int64_t kRetryNs = 1'000'000'000;

LatchRecord unreadable() {
  return {kCauseLatchUnreadable, kCauseLatchUnreadable, {}};
}

std::string utc_now() {
  const std::time_t now = utc_seconds();
  std::tm utc{};
  gmtime_r(&now, &utc);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text.data();
}

/// Returns the bits of names that are separated by blanks; nothing if a name is unknown.
std::optional<std::uint64_t> causes_named(const std::string& names) {
  std::uint64_t causes = 0;
  std::istringstream words(names);
  for (std::string word; words >> word;) {
    std::uint64_t bit = 0;
    for (const BitName& row : kStopCauseNames) {
      if (row.name == word) bit = row.bit;
    }
    if (bit == 0) return std::nullopt;
    causes |= bit;
  }
  return causes;
}

/// Splits off the first line, which begins with `key`: its rest is `value`, the following lines stay in `text`.
bool cut_line(std::string& text, const std::string& key, std::string& value) {
  if (!text.starts_with(key)) return false;
  const std::size_t end = text.find('\n');
  if (end == std::string::npos) return false;
  value = text.substr(key.size(), end - key.size());
  text.erase(0, end + 1);
  return true;
}

std::string body(const LatchRecord& record) {
  return "causes: [" + names_of(kStopCauseNames, record.causes) +
         "]\nfirst_cause: " + names_of(kStopCauseNames, record.first_cause) + "\nsince: " + record.since + "\n";
}

LatchRecord read_latch(const std::string& path) {
  std::error_code ignored;
  // The link counts, not its target: a link to nothing may lead to a disk that is not mounted.
  if (std::filesystem::symlink_status(path, ignored).type() == std::filesystem::file_type::not_found) return {};
  const InputFile file = read_input_file(path, LatchFile::kMaxSize);
  return file.problem.empty() ? parse_latch(file.text) : unreadable();
}

/// A device or FIFO would accept the record and not keep it.
void write_record(const std::string& path, const std::string& text) {
  const std::filesystem::path file(path);
  if (std::filesystem::exists(file) && !std::filesystem::is_regular_file(file)) {
    throw std::system_error(EINVAL, std::generic_category(), path + " is not a regular file");
  }
  std::filesystem::create_directories(file.parent_path());
  write_output_file(path, text);
}

std::string resolved(const std::string& path) {
  if (path.empty()) return path;
  std::error_code error;
  const std::filesystem::path whole = std::filesystem::weakly_canonical(path, error);
  return error ? path : whole.string();
}

}  // namespace

std::string latch_text(const LatchRecord& record) {
  const std::string text = body(record);
  Checksum sum;
  sum.mix(text);
  return text + "checksum: " + hex(sum.sum()) + "\n";
}

LatchRecord parse_latch(const std::string& text) {
  std::string rest = text;
  std::string causes;
  std::string first_cause;
  std::string since;
  std::string checksum;
  const bool whole = cut_line(rest, "causes: [", causes) && cut_line(rest, "first_cause: ", first_cause) &&
                     cut_line(rest, "since: ", since) && cut_line(rest, "checksum: ", checksum) && rest.empty();
  if (!whole || !causes.ends_with(']')) return unreadable();
  causes.pop_back();
  const std::optional<std::uint64_t> bits = causes_named(causes);
  const std::optional<std::uint64_t> first = causes_named(first_cause);
  if (!bits || !first) return unreadable();
  const LatchRecord record{*bits, *first, since};
  return latch_text(record) == text ? record : unreadable();
}

LatchFile::LatchFile(const std::string& path) : path_(resolved(path)) {
  if (path_.empty()) return;
  written_ = found_ = read_latch(path_);
}

void LatchFile::wait() {
  if (!writing_.valid()) return;
  problem_ = writing_.get();
  outdated_ = !problem_.empty();
}

void LatchFile::write(const LatchRecord& record) {
  written_ = record;
  next_try_ns_ = monotonic_ns() + kRetryNs;
  writing_ = std::async(std::launch::async, [path = path_, text = latch_text(record)]() -> std::string {
    try {
      write_record(path, text);
      return {};
    } catch (const std::exception& error) {
      return error.what();
    }
  });
}

void LatchFile::update(std::uint64_t causes, std::uint64_t first_cause) {
  if (path_.empty()) return;
  if (writing_.valid() && writing_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
  wait();
  LatchRecord record{causes, first_cause, written_.since};
  const bool changed = !record.same_stop(written_);
  if (!changed && (!outdated_ || monotonic_ns() < next_try_ns_)) return;
  if (causes == 0) record.since.clear();
  if (causes != 0 && record.since.empty()) record.since = utc_now();
  write(record);
}

void LatchFile::finish(std::uint64_t causes, std::uint64_t first_cause) {
  wait();
  next_try_ns_ = 0;
  update(causes, first_cause);
  wait();
}

std::uint64_t stop_owner(const MachineModel& machine) {
  ModelHash hash;
  hash.add(machine.name);
  for (const std::size_t joint : driven_joint_indices(machine)) hash.add(machine.joints[joint].name);
  return hash.value();
}

std::string latch_path(const std::string& setting, const std::string& host, const std::string& name_space,
                       const MachineModel& robot) {
  std::error_code ignored;
  if (setting.empty() || (!setting.ends_with('/') && !std::filesystem::is_directory(setting, ignored))) return setting;
  std::string name = "latch." + host;
  for (const char c : name_space) name += c == '/' ? '.' : c;
  while (name.ends_with('.')) name.pop_back();
  const std::filesystem::path folder = setting, older = folder / name;
  constexpr std::size_t kMaxName = 64;  // of 255 bytes that a file name may have
  name += '.';
  for (const char c : robot.name.substr(0, kMaxName))
    name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  std::array<char, 10> identity{};
  std::snprintf(identity.data(), identity.size(), ".%08x", static_cast<unsigned>(stop_owner(robot) & 0xffffffffU));
  const std::filesystem::path own = folder / (name + identity.data());
  if (std::filesystem::exists(older, ignored) && !std::filesystem::exists(own, ignored))
    std::filesystem::rename(older, own, ignored);
  return own.string();
}

}  // namespace robot_control
