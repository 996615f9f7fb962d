# One library per folder of src/, linked to those whose functions it calls. Who may include whom is held by
# tests/repository/test_architecture.py.
#   robot_control_library(NAME SOURCES … LINK …)

add_library(robot_control_options INTERFACE)
target_include_directories(robot_control_options INTERFACE ${PROJECT_SOURCE_DIR}/src)
# A later compiler, with which `pip install .` may build, may warn of more.
target_compile_options(robot_control_options INTERFACE
  -Wall -Wextra -Wconversion -Wshadow $<$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>:-Werror> -ffp-contract=off
  # In each cycle: no symbol is replaced by that of another library, nothing reads errno after a function of libm, and no
  # floating-point exception is trapped. So functions are inlined, and results keep their bits.
  "$<$<BOOL:$<TARGET_PROPERTY:EVERY_CYCLE>>:-fno-semantic-interposition;-fno-math-errno;-fno-trapping-math>"
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)  # GCC 12 sees overlapping copies in "literal" + string (its bug 105329)
target_link_libraries(robot_control_options INTERFACE Threads::Threads)

# Under a sanitizer. -g1: functions, files and lines of a report; the variables of -g add a third to the time of
# compilation. These flags stand before the options of a target, which therefore outweigh them.
# A null pointer that is read or written ends the program under the address sanitizer as well; to check each pointer for
# it beforehand takes 40 % of the time of compilation.
option(ROBOT_CONTROL_SANITIZE_ALL "put every library and every test program under the sanitizer" OFF)
if(ROBOT_CONTROL_SANITIZER STREQUAL "address")
  string(APPEND CMAKE_CXX_FLAGS " -fsanitize=address,undefined -fno-sanitize-recover=all -g1")
  if(NOT ROBOT_CONTROL_SANITIZE_ALL)
    string(APPEND CMAKE_CXX_FLAGS " -fno-sanitize=null")
  endif()
elseif(ROBOT_CONTROL_SANITIZER STREQUAL "thread")
  string(APPEND CMAKE_CXX_FLAGS " -fsanitize=thread -g1")
endif()
if(ROBOT_CONTROL_SANITIZER)
  set(CMAKE_CXX_FLAGS_RELEASE "-O1 -DNDEBUG")
endif()
# Libraries that give the sanitizer nothing to find: laws see neither foreign text, but for the gaits that legged_control
# reads, nor shared memory, and what one thread reads at its start has no races. With ROBOT_CONTROL_PLAIN_LIBRARIES they
# are not compiled again, but taken from there; the target `plain_libraries` of a build without a sanitizer makes them.
set(plain_under_address estimation control safety legged_estimation legged_safety)
set(plain_under_thread ${plain_under_address} legged_control files bag description machine wheeled legs parameters configuration)
set(ROBOT_CONTROL_PLAIN_LIBRARIES "" CACHE PATH "under a sanitizer: folder of libraries built without one, or empty")
add_custom_target(plain_libraries)

# Libraries that run in each cycle.
set(every_cycle rt bus machine wheeled legs estimation legged_estimation control legged_control safety legged_safety
  gate wheel_stop faults drivers mujoco loop simulation)

function(robot_control_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  if(ROBOT_CONTROL_PLAIN_LIBRARIES AND name IN_LIST plain_under_${ROBOT_CONTROL_SANITIZER})
    add_library(rc_${name} STATIC IMPORTED GLOBAL)
    set_target_properties(rc_${name} PROPERTIES IMPORTED_LOCATION ${ROBOT_CONTROL_PLAIN_LIBRARIES}/librc_${name}.a)
    target_link_libraries(rc_${name} INTERFACE robot_control_options ${ARG_LINK})
    return()
  endif()
  if(ARG_SOURCES)
    add_library(rc_${name} STATIC ${ARG_SOURCES})
    target_link_libraries(rc_${name} PUBLIC robot_control_options ${ARG_LINK})
    if(name IN_LIST every_cycle)
      set_target_properties(rc_${name} PROPERTIES EVERY_CYCLE ON)
    endif()
    if(name IN_LIST plain_under_thread)
      add_dependencies(plain_libraries rc_${name})
    endif()
  else()
    add_library(rc_${name} INTERFACE)
    target_link_libraries(rc_${name} INTERFACE robot_control_options ${ARG_LINK})
  endif()
endfunction()
