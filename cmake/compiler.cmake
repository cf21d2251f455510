# Warnings and sanitizers as one interface target that every target of ours links privately.
add_library(imgmesh_compiler INTERFACE)
target_compile_options(imgmesh_compiler INTERFACE -Wall -Wextra -Wshadow -Wconversion)
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # False alarms of g++ 12 where it has inlined std::string (such as GCC bug 105651): they come and go with what else
  # a file includes, so no change of the code keeps them away.
  target_compile_options(imgmesh_compiler INTERFACE -Wno-restrict -Wno-array-bounds -Wno-stringop-overflow
    -Wno-stringop-overread)
endif()
if(CMAKE_CXX_COMPILER_ID MATCHES Clang)
  # Eigen's and the standard library's sizes are signed and unsigned, and braces may be left out around the first member
  # of an aggregate; g++ asks for neither. Hot loops join truths by &, which does not branch.
  target_compile_options(imgmesh_compiler INTERFACE -Wno-sign-conversion -Wno-missing-braces
    -Wno-bitwise-instead-of-logical)
endif()
# Results are the same bytes on any machine of one architecture: no contraction of a*b+c that depends on flags.
target_compile_options(imgmesh_compiler INTERFACE -ffp-contract=off)
# The note on passing 32-byte vectors does not concern functions that are always inlined (libcore/base/simd.h).
target_compile_options(imgmesh_compiler INTERFACE -Wno-psabi)
# Nobody reads errno or floating-point flags; without them loops with a choice in them become vector code. No result changes.
target_compile_options(imgmesh_compiler INTERFACE -fno-trapping-math -fno-math-errno)
# The libraries go into programs and into modules that other programs load (python/). No name of ours is visible outside
# of these, so code for any address calls as directly as other code. Programs have the same flags: they share precompiled
# headers with the libraries.
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
if(NOT EMSCRIPTEN)
  target_compile_options(imgmesh_compiler INTERFACE -fPIC -fno-semantic-interposition)
endif()
if(IMGMESH_WERROR)
  target_compile_options(imgmesh_compiler INTERFACE -Werror)
endif()
if(IMGMESH_COVERAGE)
  target_compile_options(imgmesh_compiler INTERFACE -fprofile-instr-generate -fcoverage-mapping)
  target_link_options(imgmesh_compiler INTERFACE -fprofile-instr-generate)
endif()
if(IMGMESH_SANITIZE)
  target_compile_options(imgmesh_compiler INTERFACE -fsanitize=${IMGMESH_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(imgmesh_compiler INTERFACE -fsanitize=${IMGMESH_SANITIZE})
  if(IMGMESH_SANITIZE MATCHES "address,undefined" AND CMAKE_CXX_COMPILER_ID MATCHES Clang)
    # An access beyond the object is what the address sanitizer finds.
    target_compile_options(imgmesh_compiler INTERFACE -fno-sanitize=object-size
      -fsanitize-ignorelist=${PROJECT_SOURCE_DIR}/cmake/sanitizers_leave_out.txt)
  endif()
endif()
