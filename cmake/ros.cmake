# The repository as one catkin package: messages, the Python package, programs and where things are installed.
#
# Debian's ROS belongs to Debian's Python; the python3 on PATH may be another one.
set(PYTHON_EXECUTABLE /usr/bin/python3 CACHE FILEPATH "the Python that ROS was built for")

find_package(catkin REQUIRED COMPONENTS
  actionlib_msgs diagnostic_msgs dynamic_reconfigure geometry_msgs message_generation nav_msgs roscpp rosgraph_msgs roslib sensor_msgs std_msgs std_srvs
  tf2_msgs trajectory_msgs)

catkin_python_setup()
add_action_files(FILES FollowPath.action NavigateThrough.action NavigateTo.action)
file(GLOB messages RELATIVE ${CMAKE_CURRENT_SOURCE_DIR}/msg CONFIGURE_DEPENDS msg/*.msg)
file(GLOB services RELATIVE ${CMAKE_CURRENT_SOURCE_DIR}/srv CONFIGURE_DEPENDS srv/*.srv)
add_message_files(FILES ${messages})
add_service_files(FILES ${services})
generate_messages(DEPENDENCIES actionlib_msgs geometry_msgs nav_msgs std_msgs)
catkin_package(CATKIN_DEPENDS actionlib_msgs geometry_msgs message_runtime nav_msgs std_msgs)
unset(CMAKE_RUNTIME_OUTPUT_DIRECTORY)  # catkin's: test programs are no nodes

# Headers of messages that were generated before C++20, as Debian's are, name the member `rebind` of std::allocator, which
# C++20 has not. Copies with std::allocator_traits in its place, as the present generator writes it, come before them.
find_path(ROS_INCLUDE_DIR ros/serialization.h HINTS ${catkin_INCLUDE_DIRS} REQUIRED)
set(headers_for_cxx20 ${CMAKE_BINARY_DIR}/ros_headers)
file(GLOB headers RELATIVE ${ROS_INCLUDE_DIR} ${ROS_INCLUDE_DIR}/ros/serialization.h
  ${ROS_INCLUDE_DIR}/*_msgs/*.h ${ROS_INCLUDE_DIR}/*_srvs/*.h ${ROS_INCLUDE_DIR}/dynamic_reconfigure/*.h)
foreach(header IN LISTS headers)
  file(READ ${ROS_INCLUDE_DIR}/${header} old)
  string(REPLACE "ContainerAllocator::template rebind<" "std::allocator_traits<ContainerAllocator>::template rebind_alloc<" new "${old}")
  string(REPLACE ">::other" ">" new "${new}")
  string(REGEX REPLACE "#include \"([a-z_]+[.]h)" "#include \"ros/\\1" new "${new}")  # its neighbours stay behind
  if(NOT new STREQUAL old)
    file(CONFIGURE OUTPUT ${headers_for_cxx20}/${header} CONTENT "${new}" @ONLY)
  endif()
endforeach()

# robot_control_ros(TARGET): ROS headers, generated messages included, for one target.
function(robot_control_ros target)
  target_include_directories(${target} SYSTEM PUBLIC
    ${headers_for_cxx20} ${CATKIN_DEVEL_PREFIX}/include ${catkin_INCLUDE_DIRS})
  target_compile_options(${target} PUBLIC -include ros/messages/array_bound.h)
  target_link_libraries(${target} PUBLIC ${catkin_LIBRARIES})
  add_dependencies(${target} ${PROJECT_NAME}_generate_messages_cpp)
endfunction()

# robot_control_node(NAME LIBRARY…): src/main/NAME.cpp, started with `rosrun robot_control NAME`.
function(robot_control_node name)
  add_executable(${name} ${name}.cpp)
  target_link_libraries(${name} PRIVATE ${ARGN})
  set_target_properties(${name} PROPERTIES
    RUNTIME_OUTPUT_DIRECTORY ${CATKIN_DEVEL_PREFIX}/${CATKIN_PACKAGE_BIN_DESTINATION})
  install(TARGETS ${name} RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
endfunction()

set(ROBOT_CONTROL_SHARE ${CATKIN_PACKAGE_SHARE_DESTINATION})
file(GLOB tools RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} CONFIGURE_DEPENDS scripts/*.py scripts/*/*.py)
catkin_install_python(PROGRAMS ${tools} DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
