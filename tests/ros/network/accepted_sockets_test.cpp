// These tests show which connection is closed when descriptors run out.
#include "ros/network/accepted_sockets.h"

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <thread>

namespace robot_control::tests {

constexpr rlim_t kLimit = 128;

/// Healthy: a listening socket on the loopback, and a limit that leaves room for some connections.
struct AcceptedSocketsTest : testing::Test {
  AcceptedSocketsTest() : listening_(socket(AF_INET, SOCK_STREAM, 0)) {
    getrlimit(RLIMIT_NOFILE, &before_);
    const rlimit limit{.rlim_cur = kLimit, .rlim_max = before_.rlim_max};
    setrlimit(RLIMIT_NOFILE, &limit);
    address_.sin_family = AF_INET;
    address_.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    bind(listening_, reinterpret_cast<const sockaddr*>(&address_), sizeof address_);
    socklen_t length = sizeof address_;
    getsockname(listening_, reinterpret_cast<sockaddr*>(&address_), &length);
    listen(listening_, 64);
  }
  ~AcceptedSocketsTest() override {
    setrlimit(RLIMIT_NOFILE, &before_);
    for (const int descriptor : clients_) close(descriptor);
    for (const int descriptor : accepted_) close(descriptor);
    close(listening_);
  }

  /// The client's end of a new connection; `text` is sent before it is accepted.
  int connection(const char* text = "") {
    clients_.push_back(socket(AF_INET, SOCK_STREAM, 0));
    EXPECT_EQ(connect(clients_.back(), reinterpret_cast<const sockaddr*>(&address_), sizeof address_), 0);
    const std::size_t bytes = std::char_traits<char>::length(text);
    EXPECT_EQ(send(clients_.back(), text, bytes, 0), static_cast<ssize_t>(bytes));
    accepted_.push_back(accept(listening_, nullptr, nullptr));
    EXPECT_GE(accepted_.back(), 0);
    return clients_.back();
  }

  static bool is_open(int client) {
    char byte = 0;
    return recv(client, &byte, 1, MSG_DONTWAIT) < 0 && errno == EAGAIN;
  }

  void fill() {
    while (accepted_.empty() || static_cast<rlim_t>(accepted_.back()) + 2 < kLimit - reserve_of(kLimit))
      connection("x");
  }

  int listening_ = -1;
  rlimit before_{};
  sockaddr_in address_{};
  std::vector<int> clients_;
  std::vector<int> accepted_;
};

TEST_F(AcceptedSocketsTest, WhileThereIsRoomAllStay) {
  const int silent = connection();
  fill();
  EXPECT_TRUE(is_open(silent));
}

TEST_F(AcceptedSocketsTest, TheOldestThatNeverSentAByteGivesWay) {
  const int oldest = connection("x");
  const int silent = connection();
  const int younger = connection();
  fill();
  std::this_thread::sleep_for(std::chrono::milliseconds(210));
  connection();
  EXPECT_FALSE(is_open(silent));
  EXPECT_TRUE(is_open(oldest));
  EXPECT_TRUE(is_open(younger));
}

TEST_F(AcceptedSocketsTest, OneThatIsAboutToSpeakStaysBeforeAnOlderOne) {
  const int oldest = connection("x");
  fill();
  connection();
  EXPECT_FALSE(is_open(oldest));
  const int speaking = clients_.back();
  connection("x");
  EXPECT_TRUE(is_open(speaking));
}

TEST_F(AcceptedSocketsTest, OfManySilentOnesTheOldestGivesWayAtOnce) {
  const int oldest = connection("x");
  const int silent = connection();
  for (int i = 0; i < 16; ++i) connection();
  fill();
  connection();
  EXPECT_FALSE(is_open(silent));
  EXPECT_TRUE(is_open(oldest));
}

TEST_F(AcceptedSocketsTest, AnObserverFromBeforeAFloodStaysWhileItLasts) {
  const int observer = connection("x");
  std::this_thread::sleep_for(std::chrono::milliseconds(210));
  const int first_of_flood = connection("x");
  fill();
  connection("x");
  EXPECT_TRUE(is_open(observer));
  EXPECT_FALSE(is_open(first_of_flood));
}

TEST_F(AcceptedSocketsTest, AnObserverFromBeforeAFloodStaysAfterIt) {
  const int observer = connection("x");
  fill();
  const int last_of_flood = clients_.back();
  std::this_thread::sleep_for(std::chrono::milliseconds(210));
  const int call = connection("x");
  EXPECT_TRUE(is_open(observer));
  EXPECT_FALSE(is_open(last_of_flood));
  EXPECT_TRUE(is_open(call));
}

TEST_F(AcceptedSocketsTest, WhereAllAreYoungTheOldestGivesWay) {
  const int oldest = connection("x");
  const int younger = connection("x");
  fill();
  const std::uint64_t before = evicted_connections();
  connection();
  EXPECT_EQ(evicted_connections(), before + 1);
  EXPECT_FALSE(is_open(oldest));
  EXPECT_TRUE(is_open(younger));
}

TEST_F(AcceptedSocketsTest, ADescriptorThatBelongsToSomethingElseByNowIsLeftAlone) {
  const int gone = connection();
  const int number = accepted_.back();
  close(number);
  int pair[2];
  ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, pair), 0);
  ASSERT_EQ(pair[0], number);
  accepted_.back() = pair[1];
  const int silent = connection();
  fill();
  std::this_thread::sleep_for(std::chrono::milliseconds(210));
  connection();
  EXPECT_FALSE(is_open(gone));  // closed by its own end
  EXPECT_FALSE(is_open(silent));
  EXPECT_EQ(send(pair[0], "x", 1, MSG_NOSIGNAL), 1);
  close(pair[0]);
}

TEST_F(AcceptedSocketsTest, ConnectionsThatAreMadeTakeHalfOfAll) {
  int descriptor = 0;
  while ((descriptor = socket(AF_INET, SOCK_STREAM, 0)) >= 0) clients_.push_back(descriptor);
  EXPECT_EQ(errno, EMFILE);
  EXPECT_EQ(clients_.size() + 1, kLimit / 2);  // and the listening one
}

TEST_F(AcceptedSocketsTest, ConnectionsThatAreMadeLeaveMostOfTheReserveToOthers) {
  std::vector<int> files;
  while (files.empty() || static_cast<rlim_t>(files.back()) < kLimit / 2 + 10) files.push_back(dup(listening_));
  int descriptor = 0;
  while ((descriptor = socket(AF_INET, SOCK_STREAM, 0)) >= 0) clients_.push_back(descriptor);
  EXPECT_EQ(static_cast<rlim_t>(clients_.back()), kLimit - reserve_of(kLimit) * 6 / 8 - 1);
  const int other = socket(AF_UNIX, SOCK_STREAM, 0);
  EXPECT_GE(other, 0);
  close(other);
  for (const int file : files) close(file);
}

TEST(Reserve, LeavesMostOfASmallLimit) {
  EXPECT_EQ(reserve_of(1024), 64U);
  EXPECT_EQ(reserve_of(256), 64U);
  EXPECT_EQ(reserve_of(32), 8U);
}

}  // namespace robot_control::tests
