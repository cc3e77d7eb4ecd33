# SPDX-License-Identifier: Apache-2.0
# Helpers for nacre's own libraries, tests and benchmarks.

find_package(Threads REQUIRED)
find_package(hwy REQUIRED)

# The SIMD targets that kernels are compiled for, of scalar, sse4, avx2, avx3; or neon. Of Highway's
# others (SSSE3, AVX-512 with extensions, SVE) none gave enough to be worth compiling.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(aarch64|arm64)$")
  set(NACRE_TARGETS neon CACHE STRING "SIMD targets to compile for")
else()
  set(NACRE_TARGETS scalar sse4 avx2 avx3 CACHE STRING "SIMD targets to compile for")
endif()
# In Highway's names. NEON is what arm64 has at least, which Highway 1.0.3 does not tell from NEON
# with AES.
set(highway_scalar HWY_SCALAR)
set(highway_sse4 HWY_SSE4)
set(highway_avx2 HWY_AVX2)
set(highway_avx3 HWY_AVX3)
set(highway_neon HWY_NEON)
if(hwy_VERSION VERSION_GREATER_EQUAL 1.0.4)
  set(highway_neon HWY_NEON_WITHOUT_AES)
endif()
set(NACRE_HIGHWAY_TARGETS)
foreach(target ${NACRE_TARGETS})
  if(NOT highway_${target})
    message(FATAL_ERROR "NACRE_TARGETS: ${target} is none of scalar, sse4, avx2, avx3, neon")
  endif()
  list(APPEND NACRE_HIGHWAY_TARGETS ${highway_${target}})
endforeach()
list(JOIN NACRE_HIGHWAY_TARGETS "|" NACRE_HIGHWAY_TARGETS)
# Without the fallback the slowest target is what all code may use, and Highway wants to see so.
set(NACRE_BASELINE)
if(NOT "scalar" IN_LIST NACRE_TARGETS AND NOT "neon" IN_LIST NACRE_TARGETS)
  if(NOT "sse4" IN_LIST NACRE_TARGETS)
    message(FATAL_ERROR "NACRE_TARGETS: scalar, sse4 or neon must be among them")
  endif()
  set(NACRE_BASELINE -msse4.2 -maes -mpclmul)
endif()

# What every target of ours is compiled with.
add_library(nacre_options INTERFACE)
target_compile_features(nacre_options INTERFACE cxx_std_20)
target_include_directories(nacre_options INTERFACE ${CMAKE_SOURCE_DIR}/src)
# -ffp-contract=off: left alone, GCC fuses multiplies and adds across intrinsics, differently in
# each context, and then a pixel's bits would depend on which kernel computed it.
target_compile_options(nacre_options INTERFACE -ffp-contract=off -Wall -Wextra -Wconversion)
target_compile_definitions(nacre_options INTERFACE "HWY_DISABLED_TARGETS=~(${NACRE_HIGHWAY_TARGETS})")
# Highway's fallback is SCALAR or EMU128, by compiler and version. Of EMU128 in Highway 1.2, a
# division by zero is zero; this asks for SCALAR everywhere, whose numbers are C++'s.
target_compile_definitions(nacre_options INTERFACE HWY_BROKEN_EMU128=1)
# NEON is all there is, and what all code may use: without this Highway gives its functions a target
# of their own, which GCC does not give to the constructors of structs of vectors.
if("neon" IN_LIST NACRE_TARGETS)
  target_compile_definitions(nacre_options INTERFACE TOOLCHAIN_MISS_SYS_AUXV_H=1)
endif()
target_compile_options(nacre_options INTERFACE ${NACRE_BASELINE})
# Some packages bring it (Debian 13's OpenImageIO), and GCC takes a precompiled header only with the
# options that it was made with.
target_compile_options(nacre_options INTERFACE -pthread)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # Highway passes vectors between its own inlined functions only.
  target_compile_options(nacre_options INTERFACE -Wno-psabi)
  if(NACRE_UNITY)
    # GCC collects no garbage below twice this, 1 GiB: large files compile faster.
    target_compile_options(nacre_options INTERFACE --param=ggc-min-heapsize=524288)
  endif()
endif()
if(NACRE_WERROR)
  target_compile_options(nacre_options INTERFACE -Werror)
endif()

# nacre_one_unit(TARGET [SECOND FILES...] [ALONE FILES...]): with NACRE_UNITY, compiles the target's
# files as one, but for SIMD files, which are compiled once for every target; those that have helpers
# of the same name as others' are a second one, or alone. Half of a file's compile time goes into
# reading headers.
function(nacre_one_unit target)
  cmake_parse_arguments(ARG "" "" "SECOND;ALONE" ${ARGN})
  if(NOT NACRE_UNITY)
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  list(TRANSFORM ARG_SECOND PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)
  list(TRANSFORM ARG_ALONE PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)
  get_target_property(sources ${target} SOURCES)
  list(FILTER sources EXCLUDE REGEX "_kernel\\.cc$|/version\\.cc$")
  list(REMOVE_ITEM sources ${ARG_SECOND} ${ARG_ALONE})
  set_source_files_properties(${sources} PROPERTIES UNITY_GROUP first)
  set_source_files_properties(${ARG_SECOND} PROPERTIES UNITY_GROUP second)
endfunction()

# nacre_library(NAME DEPENDS... ): the library nacre_<NAME> from all of src/<NAME>/*.cc.
function(nacre_library name)
  cmake_parse_arguments(ARG "" "" "DEPENDS" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${name}/*.cc)
  if(sources)
    add_library(nacre_${name} STATIC ${sources})
    set_target_properties(nacre_${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    target_link_libraries(nacre_${name} PUBLIC nacre_options ${ARG_DEPENDS})
  else()
    add_library(nacre_${name} INTERFACE)
    target_link_libraries(nacre_${name} INTERFACE nacre_options ${ARG_DEPENDS})
  endif()
endfunction()

# nacre_fuzzed(TARGET): with NACRE_FUZZ, compiles TARGET with libFuzzer's counters and sanitizers.
function(nacre_fuzzed target)
  if(NACRE_FUZZ)
    # vptr checks would need the type information of libraries that were built without it.
    target_compile_options(${target} PRIVATE -O1 -gline-tables-only -fno-omit-frame-pointer
      -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize=vptr -fno-sanitize-recover=all)
  endif()
endfunction()

# nacre_test(FOLDER [TABLES] [LONG] DEPENDS...): one Catch2 program from tests/<FOLDER>/*_test.cc.
# TABLES: its cases tagged [table] read reference tables and make a ctest of their own,
# <FOLDER>_table, which can be run on other tables of the same form (tests/tables.h).
# LONG: so do those tagged [long], <FOLDER>_long, which then run beside the others.
function(nacre_test folder)
  cmake_parse_arguments(ARG "TABLES;LONG" "" "DEPENDS" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/*_test.cc)
  add_executable(nacre_${folder}_test ${sources})
  set_target_properties(nacre_${folder}_test PROPERTIES
    RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
  target_link_libraries(nacre_${folder}_test PRIVATE nacre_catch ${ARG_DEPENDS})
  target_include_directories(nacre_${folder}_test PRIVATE ${CMAKE_SOURCE_DIR}/tests)
  # What is tested is compiled as ever; the tests themselves are compiled for build time. Without its
  # "expensive" optimisations GCC leaves out vzeroupper, and after a kernel of a test all other code
  # runs at a sixth of its speed. At -O1 it takes a variant's other alternatives for read.
  target_compile_options(nacre_${folder}_test PRIVATE
    -O1 $<$<CXX_COMPILER_ID:GNU>:-fexpensive-optimizations;-Wno-maybe-uninitialized>)
  # Every file of tests reads Catch2, which is large. Users of the header must define all
  # macros that the first test does.
  if(NACRE_UNITY AND folder STREQUAL "base")
    target_precompile_headers(nacre_base_test PRIVATE ${CMAKE_SOURCE_DIR}/tests/catch.h)
  elseif(NACRE_UNITY)
    target_precompile_headers(nacre_${folder}_test REUSE_FROM nacre_base_test)
  endif()
  set(run $<TARGET_FILE:nacre_${folder}_test>)
  if(NOT (NACRE_EMBREE AND NACRE_OIIO))
    # Says of which cases the build refuses what they ask for.
    set(run Python3::Interpreter -B ${CMAKE_SOURCE_DIR}/tests/minimal/run_cases.py ${run})
  endif()
  add_test(NAME ${folder} COMMAND ${run} ~[table]~[long])
  if(ARG_TABLES)
    add_test(NAME ${folder}_table COMMAND ${run} [table])
  endif()
  if(ARG_LONG)
    add_test(NAME ${folder}_long COMMAND ${run} [long])
  endif()
endfunction()

# nacre_version_source(TARGET): compiles the version and commit of this checkout into TARGET.
function(nacre_version_source target)
  set(output ${CMAKE_CURRENT_BINARY_DIR}/version.cc)
  add_custom_target(nacre_version BYPRODUCTS ${output}
    COMMAND ${CMAKE_COMMAND} -DSOURCE_DIR=${CMAKE_SOURCE_DIR} -DOUTPUT=${output}
      -DVERSION=${PROJECT_VERSION} -P ${CMAKE_SOURCE_DIR}/scripts/cmake/write_version.cmake
    COMMENT "Reading the commit")
  target_sources(${target} PRIVATE ${output})
  add_dependencies(${target} nacre_version)
endfunction()
