# Where the checkout may lie. First of all, so that what cannot become a build is refused in the first second.

# catkin's own CMake code and make split such a path.
if(CMAKE_CURRENT_SOURCE_DIR MATCHES "[][ \t;:'\"$&()<>|*?#{}\\`!]")
  message(FATAL_ERROR "robot_control: the path of the checkout, ${CMAKE_CURRENT_SOURCE_DIR}, has a blank or one of "
    "'\";:$&()<>|*?#[]{}\\`! in it, which catkin and make cannot bear. Move it to a path without.")
endif()

# A checkout is a colcon workspace of its own, too. In the devel space of another workspace roslaunch and rosrun would
# look into its install/ and build/ and find every file twice.
if(NOT CMAKE_SOURCE_DIR STREQUAL CMAKE_CURRENT_SOURCE_DIR OR DEFINED CACHE{CATKIN_DEVEL_PREFIX})
  string(FIND "${CMAKE_BINARY_DIR}/" "${CMAKE_CURRENT_SOURCE_DIR}/" inside)
  if(NOT inside EQUAL 0 AND (EXISTS "${CMAKE_CURRENT_SOURCE_DIR}/install/robot_control"
                             OR EXISTS "${CMAKE_CURRENT_SOURCE_DIR}/build/robot_control"))
    message(FATAL_ERROR "robot_control: ${CMAKE_CURRENT_SOURCE_DIR} holds a build of its own, in which roslaunch and "
      "rosrun would find every file twice. Remove it: rm -r ${CMAKE_CURRENT_SOURCE_DIR}/build "
      "${CMAKE_CURRENT_SOURCE_DIR}/install")
  endif()
endif()
