#pragma once
/// A zeroed object in memory that forked children share.

#include <sys/mman.h>

#include <new>

namespace robot_control {

template <class Object>
class AnonymousMemory {
 public:
  AnonymousMemory() : data_(mmap(nullptr, sizeof(Object), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0)) {
    if (data_ == MAP_FAILED) throw std::bad_alloc();
  }
  AnonymousMemory(const AnonymousMemory&) = delete;
  AnonymousMemory& operator=(const AnonymousMemory&) = delete;
  ~AnonymousMemory() { munmap(data_, sizeof(Object)); }

  Object* get() const noexcept { return static_cast<Object*>(data_); }
  Object* operator->() const noexcept { return get(); }

 private:
  void* data_;
};

}  // namespace robot_control
