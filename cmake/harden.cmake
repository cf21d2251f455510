# What makes a defect in a reader of files hard to use (docs/decisions/0030-hardened-build.md): flags of the target
# imgmesh_compiler, for all of our code, in this build only. Nothing of it is exported: whoever links the libraries
# chooses for the own program.
option(IMGMESH_HARDEN "Build with the protections of compiler and linker; never with sanitizers" ON)
set(IMGMESH_HARDENED OFF)
if(IMGMESH_HARDEN AND NOT IMGMESH_SANITIZE)
  set(IMGMESH_HARDENED ON)
endif()

# imgmesh_check_indices(TARGET): for code that holds what strangers' files say. The standard library ends the program at
# an index beyond the end. libcore's loops over pixels, whose indices come from checked sizes, are left alone.
function(imgmesh_check_indices target)
  if(IMGMESH_HARDENED)
    target_compile_definitions(${target} PRIVATE _GLIBCXX_ASSERTIONS)
  endif()
endfunction()

if(NOT IMGMESH_HARDENED)
  return()
endif()
include(CheckCXXCompilerFlag)
include(CheckLinkerFlag)

# The processor's control-flow protection has a name for each architecture, and compilers lack one or the other.
foreach(_flag -fstack-protector-strong -fstack-clash-protection -fcf-protection=full -mbranch-protection=standard)
  string(MAKE_C_IDENTIFIER IMGMESH_HAS${_flag} _known)
  check_cxx_compiler_flag("-Werror ${_flag}" ${_known})
  if(${_known})
    target_compile_options(imgmesh_compiler INTERFACE $<BUILD_INTERFACE:${_flag}>)
  endif()
endforeach()
# The C library checks lengths only in optimised code, and warns in other. Distributions may have set another level.
target_compile_options(imgmesh_compiler INTERFACE
  $<BUILD_INTERFACE:$<$<NOT:$<CONFIG:Debug>>:-U_FORTIFY_SOURCE>>
  $<BUILD_INTERFACE:$<$<NOT:$<CONFIG:Debug>>:-D_FORTIFY_SOURCE=3>>)

# Programs at any address; cmake/compiler.cmake compiles for that.
set(_is_program $<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>)
target_link_options(imgmesh_compiler INTERFACE $<BUILD_INTERFACE:$<${_is_program}:-pie>>)
foreach(_word relro now noexecstack)
  check_linker_flag(CXX -Wl,-z,${_word} IMGMESH_LINKS_${_word})
  if(IMGMESH_LINKS_${_word})
    target_link_options(imgmesh_compiler INTERFACE $<BUILD_INTERFACE:-Wl,-z,${_word}>)
  endif()
endforeach()
