#include "rt/shared_memory.h"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <system_error>

#include "rt/clock.h"
#include "rt/futex.h"
#include "support/processes/child_process.h"

namespace robot_control::tests {

constexpr std::size_t kBytes = 8192;

/// An object of kBytes, mapped by its creator.
struct SharedMemoryTest : testing::Test {
  SharedMemoryTest() : object_(*SharedMemory::create(name_)) {
    object_.reserve(kBytes);
    mapping_ = object_.map(kBytes);
  }
  ~SharedMemoryTest() override { shm_unlink(name_.c_str()); }

  SharedMemory reader() const { return std::move(*SharedMemory::open(name_, Access::kReadOnly)); }
  std::atomic<std::uint32_t>& word() const { return *static_cast<std::atomic<std::uint32_t>*>(mapping_.data()); }

  const std::string name_ = "/robot_control.test." + std::to_string(getpid());
  SharedMemory object_;
  MemoryMapping mapping_;
};

TEST_F(SharedMemoryTest, IsThereOnlyOnce) {
  EXPECT_FALSE(SharedMemory::create(name_));
}

TEST_F(SharedMemoryTest, IsEmptyIfThereIsNoSuchName) {
  EXPECT_FALSE(SharedMemory::open(name_ + ".no", Access::kReadOnly));
}

TEST_F(SharedMemoryTest, IsPrivateWhateverTheUmask) {
  const std::string name = name_ + ".umask";
  const mode_t before = umask(0777);
  const std::optional<SharedMemory> object = SharedMemory::create(name);
  umask(before);
  shm_unlink(name.c_str());
  ASSERT_TRUE(object);
  EXPECT_TRUE(object->is_private());
}

TEST_F(SharedMemoryTest, OpenToOthersIsNotPrivate) {
  ASSERT_EQ(chmod(("/dev/shm" + name_).c_str(), 0640), 0);
  EXPECT_FALSE(object_.is_private());
}

TEST_F(SharedMemoryTest, IsNotPrivateIfItIsOfAnotherUser) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can give an object away";
  ASSERT_EQ(chown(("/dev/shm" + name_).c_str(), 65534, 65534), 0);
  EXPECT_FALSE(object_.is_private());
}

TEST_F(SharedMemoryTest, IsSharedBetweenMappings) {
  word().store(42);
  const MemoryMapping view = reader().map(kBytes);
  EXPECT_EQ(static_cast<const std::atomic<std::uint32_t>*>(view.data())->load(), 42u);
}

TEST_F(SharedMemoryTest, RefusesToMapBeyondItsEnd) {
  EXPECT_THROW(reader().map(kBytes + 1), std::system_error);
}

TEST_F(SharedMemoryTest, RefusesToMapATruncatedObject) {
  ASSERT_EQ(truncate(("/dev/shm" + name_).c_str(), 100), 0);
  EXPECT_THROW(reader().map(kBytes), std::system_error);
  std::uint64_t word = 0;
  EXPECT_TRUE(reader().read_at(0, &word, sizeof word));
  EXPECT_FALSE(reader().read_at(96, &word, sizeof word));
}

TEST_F(SharedMemoryTest, TheLockIsTakenOnce) {
  SharedMemory second = std::move(*SharedMemory::open(name_, Access::kReadWrite));
  EXPECT_TRUE(object_.lock());
  EXPECT_FALSE(second.lock());
}

TEST_F(SharedMemoryTest, AReadOnlyDescriptorSeesTheLock) {
  EXPECT_FALSE(reader().locked_elsewhere());
  ASSERT_TRUE(object_.lock());
  EXPECT_TRUE(reader().locked_elsewhere());
  EXPECT_FALSE(object_.locked_elsewhere());  // the own lock does not count
}

TEST_F(SharedMemoryTest, TheLockEndsWithAKilledProcess) {
  ChildProcess owner([&] {
    SharedMemory mine = std::move(*SharedMemory::open(name_, Access::kReadWrite));
    word().store(mine.lock() ? 1 : 2);
    futex_wake_all(word());
    pause();
    return 0;
  });
  ASSERT_TRUE(futex_wait(word(), 0, 10'000'000'000));
  ASSERT_EQ(word().load(), 1u);
  EXPECT_TRUE(reader().locked_elsewhere());
  owner.kill();
  EXPECT_FALSE(reader().locked_elsewhere());
  EXPECT_TRUE(object_.lock());
}

TEST_F(SharedMemoryTest, KnowsWhenItsNameBelongsToAnother) {
  EXPECT_TRUE(object_.still_named());
  shm_unlink(name_.c_str());
  EXPECT_FALSE(object_.still_named());
  const std::optional<SharedMemory> successor = SharedMemory::create(name_);
  EXPECT_FALSE(object_.still_named());
  EXPECT_TRUE(successor->still_named());
}

TEST_F(SharedMemoryTest, AMappingOutlivesNameAndDescriptor) {
  MemoryMapping view;
  {
    const SharedMemory closing = reader();
    view = closing.map(kBytes);
  }
  shm_unlink(name_.c_str());
  word().store(43);
  EXPECT_EQ(static_cast<const std::atomic<std::uint32_t>*>(view.data())->load(), 43u);
}

TEST_F(SharedMemoryTest, AWaitOnAReadOnlyMappingIsWokenByAnotherProcess) {
  const MemoryMapping view = reader().map(kBytes);
  const auto& seen = *static_cast<const std::atomic<std::uint32_t>*>(view.data());
  ChildProcess writer([&] {
    sleep_ns(50'000'000);
    word().store(1);
    futex_wake_all(word());
    return 0;
  });
  const std::int64_t before_ns = monotonic_ns();
  EXPECT_TRUE(futex_wait(seen, 0, 10'000'000'000));
  EXPECT_LT(monotonic_ns() - before_ns, 5'000'000'000);  // woken, not timed out
}

}  // namespace robot_control::tests
