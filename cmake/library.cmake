# One library per folder of src/, linked to those whose functions it calls. Who may include whom is held by
# tests/tools/test_architecture.py.
#   robot_control_library(NAME SOURCES … LINK …)

add_library(robot_control_options INTERFACE)
target_include_directories(robot_control_options INTERFACE ${PROJECT_SOURCE_DIR}/src)
target_compile_options(robot_control_options INTERFACE
  -Wall -Wextra -Wconversion -Wshadow -Werror -ffp-contract=off
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)  # GCC 12 sees overlapping copies in "literal" + string (its bug 105329)
target_link_libraries(robot_control_options INTERFACE Threads::Threads)

# Under a sanitizer. -g1: functions, files and lines of a report; the variables of -g add a third to the time of
# compilation. These flags stand before the options of a target, which therefore outweigh them.
option(ROBOT_CONTROL_SANITIZE_ALL "put every library and every test program under the sanitizer" OFF)
if(ROBOT_CONTROL_SANITIZER STREQUAL "address")
  string(APPEND CMAKE_CXX_FLAGS " -fsanitize=address,undefined -fno-sanitize-recover=all -g1")
elseif(ROBOT_CONTROL_SANITIZER STREQUAL "thread")
  string(APPEND CMAKE_CXX_FLAGS " -fsanitize=thread -g1")
endif()
# UBSan's check of null pointers runs at night alone: an access through one ends the program under ASan, too.
if(ROBOT_CONTROL_SANITIZER STREQUAL "address" AND NOT ROBOT_CONTROL_SANITIZE_ALL)
  string(APPEND CMAKE_CXX_FLAGS " -fno-sanitize=null")
endif()
if(ROBOT_CONTROL_SANITIZER)
  set(CMAKE_CXX_FLAGS_RELEASE "-O1 -DNDEBUG")
endif()
# Where ROBOT_CONTROL_WORKSPACE names the build folder of the workspace, libraries that give the sanitizer nothing to find are
# that build's: laws see neither foreign text nor shared memory, and what one thread reads at its
# start has no races. They are linked last, for of an inline function that both sides have compiled the linker keeps the first.
set(ROBOT_CONTROL_WORKSPACE "" CACHE PATH "build folder of the workspace, whose libraries a sanitizer's build may link")
set(plain_under_address estimation control safety legs legged_estimation legged_control legged_safety wheel_stop)
set(plain_under_thread ${plain_under_address} files bag description machine wheeled parameters configuration)
set(plain)
if(ROBOT_CONTROL_WORKSPACE AND NOT ROBOT_CONTROL_SANITIZE_ALL)
  set(plain ${plain_under_${ROBOT_CONTROL_SANITIZER}})
  list(TRANSFORM plain REPLACE "(.+)" "${ROBOT_CONTROL_WORKSPACE}/devel/lib/librc_\\1.a" OUTPUT_VARIABLE plain_files)
  list(JOIN plain_files " " plain_files)
  string(REPLACE "<LINK_LIBRARIES>" "-Wl,--start-group <LINK_LIBRARIES> ${plain_files} -Wl,--end-group"
    CMAKE_CXX_LINK_EXECUTABLE "${CMAKE_CXX_LINK_EXECUTABLE}")
endif()

function(robot_control_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  if(name IN_LIST plain)
    add_library(rc_${name} INTERFACE)
    target_link_libraries(rc_${name} INTERFACE robot_control_options ${ARG_LINK})
    set_target_properties(rc_${name} PROPERTIES
      INTERFACE_LINK_DEPENDS ${ROBOT_CONTROL_WORKSPACE}/devel/lib/librc_${name}.a)
  elseif(ARG_SOURCES)
    add_library(rc_${name} STATIC ${ARG_SOURCES})
    target_link_libraries(rc_${name} PUBLIC robot_control_options ${ARG_LINK})
  else()
    add_library(rc_${name} INTERFACE)
    target_link_libraries(rc_${name} INTERFACE robot_control_options ${ARG_LINK})
  endif()
endfunction()
