// Checks how the replaced functions of roscpp handle data of peers.
#include "ros/network/wire_guard.h"

#include <gtest/gtest.h>
#include <ros/header.h>
#include <sys/mman.h>
#include <unistd.h>
#include <xmlrpcpp/XmlRpcSocket.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <cstring>
#include <random>

#include "ros/network/interposition.h"

namespace robot_control::tests {

std::string field(const std::string& text, std::uint32_t length) {
  std::string bytes(sizeof length, '\0');
  std::memcpy(bytes.data(), &length, sizeof length);
  return bytes + text;
}

std::string field(const std::string& text) {
  return field(text, static_cast<std::uint32_t>(text.size()));
}

/// The header lies at the end of mapped memory, so that a read beyond it is a fault.
class HeaderAtTheEdge {
 public:
  explicit HeaderAtTheEdge(const std::string& bytes) : size_(static_cast<std::uint32_t>(bytes.size())) {
    void* const pages = mmap(nullptr, 2 * kPage, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    pages_ = static_cast<std::uint8_t*>(pages);
    mprotect(pages_ + kPage, kPage, PROT_NONE);
    std::memcpy(begin(), bytes.data(), size_);
  }
  HeaderAtTheEdge(const HeaderAtTheEdge&) = delete;
  HeaderAtTheEdge& operator=(const HeaderAtTheEdge&) = delete;
  ~HeaderAtTheEdge() { munmap(pages_, 2 * kPage); }

  bool parse(ros::Header& header, std::string& problem) { return header.parse(begin(), size_, problem); }

 private:
  static constexpr std::size_t kPage = 4096;

  std::uint8_t* begin() { return pages_ + kPage - size_; }

  std::uint8_t* pages_ = nullptr;
  std::uint32_t size_ = 0;
};

bool parses(const std::string& bytes) {
  ros::Header header;
  std::string problem;
  const bool good = HeaderAtTheEdge(bytes).parse(header, problem);
  EXPECT_EQ(good, problem.empty()) << problem;
  return good;
}

TEST(WireGuard, TheLoadedRoscppCallsTheseChecks) {
  EXPECT_EQ(unguarded(), "");
}

TEST(WireGuard, AFunctionThatRoscppDefinesItselfDoesNotLeadHere) {
  EXPECT_FALSE(leads_here({.library = "libroscpp.so", .symbol = "_ZN3ros8shutdownEv", .description = ""}));
  EXPECT_FALSE(leads_here({.library = "libroscpp.so", .symbol = "robot_control_has_none", .description = ""}));
  EXPECT_FALSE(leads_here({.library = "libnone.so", .symbol = "accept", .description = ""}));
}

TEST(WireGuard, ASoundHeaderIsTakenAsItIs) {
  ros::Header header;
  std::string problem;
  std::string value;
  HeaderAtTheEdge bytes(field("topic=/odom") + field("empty=") + field("equation=a=b"));
  ASSERT_TRUE(bytes.parse(header, problem)) << problem;
  EXPECT_EQ(header.getValues()->size(), 3U);
  EXPECT_TRUE(header.getValue("topic", value) && value == "/odom");
  EXPECT_TRUE(header.getValue("empty", value) && value.empty());
  EXPECT_TRUE(header.getValue("equation", value) && value == "a=b");
  EXPECT_TRUE(parses(""));
}

TEST(WireGuard, AHeaderWhoseFieldsExceedItIsRefused) {
  const std::string sound = field("topic=/odom");
  for (const std::uint32_t length : {12U, 13U, 1000U, 999'999U, 1'000'000U, 1'000'001U, 0x7FFFFFFFU, 0xFFFFFFFFU}) {
    EXPECT_FALSE(parses(field("topic=/odom", length))) << length;
    EXPECT_FALSE(parses(sound + field("a=b", length))) << length;
  }
  for (std::size_t rest = 1; rest < 4; ++rest) EXPECT_FALSE(parses(sound + std::string(rest, '\0'))) << rest;
  EXPECT_FALSE(parses(field("no equals sign")));
  EXPECT_FALSE(parses(field("")));
}

TEST(WireGuard, NoRandomHeaderIsReadBeyondItsEnd) {
  std::mt19937 random(1);
  const std::string sound = field("topic=/odom") + field("type=*") + field("md5sum=*");
  for (int i = 0; i < 100'000; ++i) {
    std::string bytes = sound.substr(0, random() % (sound.size() + 1));
    for (std::size_t k = random() % 4; k > 0 && !bytes.empty(); --k) {
      bytes[random() % bytes.size()] = static_cast<char>(random() % 4 == 0 ? random() : random() % 24);
    }
    parses(bytes);
  }
}

/// An array with that many levels, as XML-RPC writes it.
std::string nested(int levels) {
  std::string text;
  for (int i = 0; i < levels; ++i) text += "<value><array><data>";
  text += "<value><i4>1</i4></value>";
  for (int i = 0; i < levels; ++i) text += "</data></array></value>";
  return text;
}

TEST(WireGuard, AValueIsNestedAsDeepAsTheLimitAndNoDeeper) {
  int offset = 0;
  XmlRpc::XmlRpcValue value(nested(kMaxValueDepth - 1), &offset);
  for (int level = 1; level < kMaxValueDepth; ++level) {
    ASSERT_EQ(value.getType(), XmlRpc::XmlRpcValue::TypeArray);
    const XmlRpc::XmlRpcValue inner = value[0];
    value = inner;
  }
  EXPECT_EQ(static_cast<int>(value), 1);
  offset = 0;
  const XmlRpc::XmlRpcValue deep(nested(100'000), &offset);  // would need tens of megabytes of stack
}

TEST(WireGuard, ARequestHasAnEnd) {
  const int file = memfd_create("request", 0);
  ASSERT_EQ(ftruncate(file, 4 * static_cast<off_t>(kMaxXmlRequest)), 0);
  std::string text;
  bool eof = false;
  EXPECT_FALSE(XmlRpc::XmlRpcSocket::nbRead(file, text, &eof));
  EXPECT_LE(text.size(), kMaxXmlRequest + 4096);
  ASSERT_EQ(ftruncate(file, 1000), 0);
  lseek(file, 0, SEEK_SET);
  text.clear();
  EXPECT_TRUE(XmlRpc::XmlRpcSocket::nbRead(file, text, &eof));
  EXPECT_TRUE(eof);
  EXPECT_EQ(text.size(), 1000U);
  close(file);
}

}  // namespace robot_control::tests
