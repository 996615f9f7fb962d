# One library per folder of src/, linked to those whose functions it calls. Who may include whom is held by
# tests/tools/test_architecture.py.
#   robot_control_library(NAME SOURCES … LINK …)

add_library(robot_control_options INTERFACE)
target_include_directories(robot_control_options INTERFACE ${PROJECT_SOURCE_DIR}/src)
target_compile_options(robot_control_options INTERFACE
  -Wall -Wextra -Wconversion -Wshadow -Werror -ffp-contract=off
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)  # GCC 12 sees overlapping copies in "literal" + string (its bug 105329)
target_link_libraries(robot_control_options INTERFACE Threads::Threads)
# -g1: functions, files and lines of a report; the variables of -g add a third to the time of compilation.
if(ROBOT_CONTROL_SANITIZER STREQUAL "address")
  target_compile_options(robot_control_options INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=all -g1 -O1)
  target_link_options(robot_control_options INTERFACE -fsanitize=address,undefined)
elseif(ROBOT_CONTROL_SANITIZER STREQUAL "thread")
  target_compile_options(robot_control_options INTERFACE -fsanitize=thread -g1 -O1)
  target_link_options(robot_control_options INTERFACE -fsanitize=thread)
endif()

function(robot_control_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  if(ARG_SOURCES)
    add_library(rc_${name} STATIC ${ARG_SOURCES})
    target_link_libraries(rc_${name} PUBLIC robot_control_options ${ARG_LINK})
  else()
    add_library(rc_${name} INTERFACE)
    target_link_libraries(rc_${name} INTERFACE robot_control_options ${ARG_LINK})
  endif()
endfunction()
