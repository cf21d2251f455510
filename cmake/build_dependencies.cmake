# What only building imgmesh needs: the tools and the OpenImageIO module. Programs that link the libraries do without.
find_package(CLI11 CONFIG REQUIRED)

# Debian's OpenImageIO names include folders (/usr/include/opencv4) that its package does not bring; CMake would
# refuse to generate. Keep those that exist.
find_package(OpenImageIO CONFIG REQUIRED)
get_target_property(_dirs OpenImageIO::OpenImageIO INTERFACE_INCLUDE_DIRECTORIES)
set(_existing "")
foreach(_dir IN LISTS _dirs)
  if(IS_DIRECTORY ${_dir})
    list(APPEND _existing ${_dir})
  endif()
endforeach()
set_target_properties(OpenImageIO::OpenImageIO PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${_existing}")
pkg_check_modules(Toml REQUIRED tomlplusplus)

# The Python module, for the distribution's Python and no other that PATH may have. Python itself is not sanitized.
if(NOT DEFINED Python_EXECUTABLE)
  set(Python_EXECUTABLE /usr/bin/python3)
endif()
find_package(Python 3.9 COMPONENTS Interpreter Development.Module QUIET)
find_package(pybind11 CONFIG QUIET)
set(_python OFF)
if(pybind11_FOUND AND Python_Development.Module_FOUND AND NOT IMGMESH_SANITIZE)
  set(_python ON)
endif()
option(IMGMESH_PYTHON_MODULE "Build the Python module (pybind11-dev, python3-dev)" ${_python})
