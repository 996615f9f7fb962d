#include "drivers/mujoco/mujoco_errors.h"

#include <mujoco/mujoco.h>

#include <array>
#include <csetjmp>
#include <cstring>
#include <string>

#include "drivers/driver.h"

namespace robot_control {
namespace {

thread_local std::array<char, 256> message{};
thread_local std::jmp_buf* way_out = nullptr;

void keep(const char* text) noexcept {
  std::strncpy(message.data(), text, message.size() - 1);
}

void on_warning(const char* text) {
  keep(text);
}

void on_error(const char* text) {
  keep(text);
  if (way_out != nullptr) std::longjmp(*way_out, 1);
  throw DriverError("MuJoCo: " + std::string(text));
}

}  // namespace

void install_mujoco_handlers() {
  mju_user_warning = on_warning;
  mju_user_error = on_error;
}

bool run_guarded(void (*function)(void*), void* context) noexcept {
  std::jmp_buf here;
  way_out = &here;
  if (setjmp(here) != 0) {
    way_out = nullptr;
    return false;
  }
  function(context);
  way_out = nullptr;
  return true;
}

const char* last_mujoco_message() noexcept {
  return message.data();
}

}  // namespace robot_control
