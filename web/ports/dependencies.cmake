# The libraries' headers for WebAssembly. They stand in the machine's own folder of headers, whose C headers must not be
# found; so links to those that are needed stand in a folder of their own.
set(_headers ${CMAKE_BINARY_DIR}/headers)
file(MAKE_DIRECTORY ${_headers})
foreach(_name eigen3/Eigen nlohmann tiny_gltf.h Imath/half.h Imath/ImathExport.h Imath/ImathNamespace.h
    Imath/ImathConfig.h Imath/ImathPlatform.h)
  get_filename_component(_link ${_name} NAME)
  if(NOT EXISTS /usr/include/${_name})
    message(FATAL_ERROR "/usr/include/${_name} is not there; './run setup studio' installs it")
  endif()
  file(CREATE_LINK /usr/include/${_name} ${_headers}/${_link} SYMBOLIC)
endforeach()
add_library(imgmesh_headers INTERFACE)
target_include_directories(imgmesh_headers SYSTEM INTERFACE ${_headers})
add_library(Eigen3::Eigen ALIAS imgmesh_headers)
add_library(nlohmann_json::nlohmann_json ALIAS imgmesh_headers)
# libcore does without it here (libcore/base/parallel_serial.cpp).
add_library(imgmesh_no_tbb INTERFACE)
add_library(TBB::tbb ALIAS imgmesh_no_tbb)

# Numbers are as in any other build: 32-bit sizes are what -Wconversion is silent about on the other machines.
add_compile_options(-msimd128 -fwasm-exceptions -include ${CMAKE_CURRENT_SOURCE_DIR}/web/ports/cxx20.h
  -Wno-shorten-64-to-32 -Wno-implicit-int-conversion)
add_link_options(-fwasm-exceptions)
