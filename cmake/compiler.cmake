# Warnings, optimisation and sanitizers, as one interface target.

add_library(chiaro_compiler INTERFACE)
target_compile_options(chiaro_compiler INTERFACE -Wall -Wextra -Wpedantic -Wshadow -fno-math-errno)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # Of correct code of Eigen and of the standard library GCC 12 says this; what is true of ours the sanitizers find.
  target_compile_options(chiaro_compiler INTERFACE -Wno-array-bounds -Wno-maybe-uninitialized -Wno-restrict
    -Wno-stringop-overflow -Wno-stringop-overread -Wno-use-after-free)
  # Kilobytes: templates outgrow GCC's default again and again, and a tenth of the build would be garbage collection.
  target_compile_options(chiaro_compiler INTERFACE --param=ggc-min-heapsize=400000)
endif()
if(CHIARO_WARNINGS_AS_ERRORS)
  target_compile_options(chiaro_compiler INTERFACE -Werror)
endif()

# The baseline that every 64-bit PC since 2009 runs; hot kernels are compiled for wider units too and choose at run time.
if(CMAKE_SYSTEM_PROCESSOR STREQUAL "x86_64")
  target_compile_options(chiaro_compiler INTERFACE -march=x86-64-v2)
endif()

if(CHIARO_SANITIZERS)
  set(instrumented -fsanitize=${CHIARO_SANITIZERS})
  if(CHIARO_SANITIZERS_WITHOUT)
    list(APPEND instrumented -fno-sanitize=${CHIARO_SANITIZERS_WITHOUT})
  endif()
  if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    list(APPEND instrumented -fsanitize-ignorelist=${CMAKE_CURRENT_LIST_DIR}/unsanitized_headers.txt)
  endif()
  target_compile_options(chiaro_compiler INTERFACE -fno-omit-frame-pointer
    "$<$<NOT:$<BOOL:$<TARGET_PROPERTY:CHIARO_UNSANITIZED>>>:${instrumented}>"
    -O1 -g1)  # more of either makes the build many times longer and finds nothing more
  target_link_options(chiaro_compiler INTERFACE -fsanitize=${CHIARO_SANITIZERS})
  target_compile_definitions(chiaro_compiler INTERFACE CHIARO_SANITIZED)
  # By what GCC defines with the address sanitizer Eigen would align memory itself, and the test cases, without it, would
  # free that as malloc's, which is aligned to 16 bytes anyway.
  target_compile_definitions(Eigen3::Eigen INTERFACE EIGEN_MALLOC_ALREADY_ALIGNED=1)
endif()
