# With IMGMESH_UNITY, files of one target are compiled together, several as one: what they share of JSON, CLI11, pybind11,
# doctest and Eigen is then compiled once. For those who build everything once, as .ci/run does; who edits a file waits
# longer. Files that define one name twice stay apart (cmake/unity_groups.py), and so do those with flags of their own.
# libcore would gain little: what takes its time is the optimisation of its own loops.
option(IMGMESH_UNITY "Compile several files of a target as one" OFF)
if(NOT IMGMESH_UNITY)
  return()
endif()
find_package(Python3 REQUIRED COMPONENTS Interpreter)

set(_lists "")
set(_joined "")
foreach(_folder formats tools python tests tests/bench tests/fuzz)
  if(_folder STREQUAL python AND NOT IMGMESH_PYTHON_MODULE OR _folder MATCHES tests AND NOT IMGMESH_TESTS)
    continue()
  endif()
  get_property(_targets DIRECTORY ${PROJECT_SOURCE_DIR}/${_folder} PROPERTY BUILDSYSTEM_TARGETS)
  list(APPEND _joined ${_targets})
endforeach()
foreach(_target IN LISTS _joined)
  get_target_property(_type ${_target} TYPE)
  if(NOT _type MATCHES "EXECUTABLE|STATIC_LIBRARY|MODULE_LIBRARY")
    continue()
  endif()
  get_target_property(_sources ${_target} SOURCES)
  get_target_property(_folder ${_target} SOURCE_DIR)
  set(_line ${_target})
  foreach(_source IN LISTS _sources)
    cmake_path(ABSOLUTE_PATH _source BASE_DIRECTORY ${_folder})
    get_source_file_property(_options ${_source} DIRECTORY ${_folder} COMPILE_OPTIONS)
    get_source_file_property(_definitions ${_source} DIRECTORY ${_folder} COMPILE_DEFINITIONS)
    if(_source MATCHES "\\.cpp$" AND NOT _options AND NOT _definitions)
      string(APPEND _line "|${_source}")
    endif()
  endforeach()
  string(APPEND _lists "${_line}\n")
endforeach()
file(WRITE ${CMAKE_BINARY_DIR}/unity_sources.txt "${_lists}")

# Lines of the answer: target|group|source.
execute_process(
  COMMAND ${Python3_EXECUTABLE} -B ${CMAKE_CURRENT_LIST_DIR}/unity_groups.py ${CMAKE_BINARY_DIR}/unity_sources.txt
  OUTPUT_VARIABLE _groups OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
string(REPLACE "\n" ";" _groups "${_groups}")
foreach(_line IN LISTS _groups)
  string(REPLACE "|" ";" _line "${_line}")
  list(GET _line 0 _target)
  list(GET _line 1 _group)
  list(GET _line 2 _source)
  get_target_property(_folder ${_target} SOURCE_DIR)
  set_target_properties(${_target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  set_source_files_properties(${_source} DIRECTORY ${_folder} PROPERTIES UNITY_GROUP ${_group})
endforeach()

# A tool takes from a library the objects that it needs. Joined, they bring files that read images, to tools that read none.
target_link_libraries(imgmesh_tool_common INTERFACE imgmesh_picture)
