# SPDX-License-Identifier: Apache-2.0
# Two functions that define every module and test directory the same way.

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
# Release disables assertions but keeps IEEE arithmetic: code must not assume finite numbers,
# because it catches NaN, and contraction is off so that a build with other vector units gives
# bit-identical results.
set(CMAKE_CXX_FLAGS_RELEASE "-O2 -DNDEBUG")

add_library(navvy_flags INTERFACE)
target_compile_options(navvy_flags INTERFACE -Wall -Wextra -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual -ffp-contract=off)
if(NAVVY_PRECOMPILE AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # GCC 12 forgets that precompiled text came from system headers, and warns of writes out of bounds
  # in std::string, a known false alarm. Builds without precompiled headers (preset core) keep these
  # warnings.
  target_compile_options(navvy_flags INTERFACE -Wno-array-bounds -Wno-restrict -Wno-stringop-overflow -Wno-stringop-overread)
endif()
if(NAVVY_WARNINGS_AS_ERRORS)
  target_compile_options(navvy_flags INTERFACE -Werror)
endif()
if(NAVVY_SANITIZE_THREAD)
  target_compile_options(navvy_flags INTERFACE -fsanitize=thread -fno-omit-frame-pointer)
  target_link_options(navvy_flags INTERFACE -fsanitize=thread)
endif()
if(NAVVY_FUZZ)
  target_compile_options(navvy_flags INTERFACE -fsanitize=fuzzer-no-link)
  if(NAVVY_FUZZ_SANITIZE)
    # Undefined behaviour is checked in Navvy's code; addresses are checked in the headers of
    # libraries, too. Checking both there makes compiling half as long again. The path is relative
    # so that the compiler cache serves every clone.
    file(RELATIVE_PATH libraries ${PROJECT_BINARY_DIR} ${PROJECT_SOURCE_DIR}/tests/sanitize/libraries.txt)
    target_compile_options(navvy_flags INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=undefined
                           -fsanitize-blacklist=${libraries})
    target_link_options(navvy_flags INTERFACE -fsanitize=address,undefined)
  else()
    # Optimised for speed: tracing comparisons takes a third of the time, and the build under
    # sanitizers traces them.
    target_compile_options(navvy_flags INTERFACE -fno-sanitize-coverage=trace-cmp,indirect-calls)
    # Programs that are no fuzz targets need the functions of the counters, too.
    target_link_options(navvy_flags INTERFACE -fsanitize=fuzzer-no-link)
  endif()
endif()

# Headers that nearly every file includes: with Eigen they take half of a small file's compile time.
set(NAVVY_COMMON_HEADERS <Eigen/Core> <Eigen/Geometry> <algorithm> <cmath> <cstdint> <functional> <map> <memory> <optional>
    <string> <utility> <vector>)

# navvy_module(NAME [SUBDIRS dir...] [SOURCES generated files...] [DEPS navvy modules...]
# [PUBLIC libs...] [PRIVATE libs...]) Defines one static library per folder of src/, made of all its
# .cpp files (and those of SUBDIRS); headers are included as "NAME/file.h". Alias navvy::NAME.
function(navvy_module name)
  cmake_parse_arguments(M "" "" "SUBDIRS;SOURCES;DEPS;PUBLIC;PRIVATE" ${ARGN})
  set(patterns ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  foreach(dir ${M_SUBDIRS})
    list(APPEND patterns ${CMAKE_CURRENT_SOURCE_DIR}/${dir}/*.cpp)
  endforeach()
  file(GLOB sources CONFIGURE_DEPENDS ${patterns})
  list(APPEND sources ${M_SOURCES})
  if(NOT sources)
    set(kind INTERFACE)
    set(public INTERFACE)
    add_library(navvy_${name} INTERFACE)
  else()
    set(kind STATIC)
    set(public PUBLIC)
    add_library(navvy_${name} STATIC ${sources})
    target_link_libraries(navvy_${name} PRIVATE $<BUILD_INTERFACE:navvy_flags> ${M_PRIVATE})
  endif()
  if(NAVVY_PRECOMPILE AND kind STREQUAL STATIC)
    if(name STREQUAL core)
      target_precompile_headers(navvy_core PRIVATE ${NAVVY_COMMON_HEADERS})
    else()
      target_precompile_headers(navvy_${name} REUSE_FROM navvy_core)
    endif()
  endif()
  add_library(navvy::${name} ALIAS navvy_${name})
  set_target_properties(navvy_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(navvy_${name} ${public} $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src>
                             $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/navvy>)
  target_compile_features(navvy_${name} ${public} cxx_std_20)
  foreach(dep ${M_DEPS})
    target_link_libraries(navvy_${name} ${public} navvy_${dep})
  endforeach()
  target_link_libraries(navvy_${name} ${public} ${M_PUBLIC})
  set_property(GLOBAL APPEND PROPERTY NAVVY_MODULES navvy_${name})
endfunction()

# navvy_define(DEFINITION files...): defines it for these files of the folder only. All other
# objects are independent of the build type, so the compiler cache serves one preset with the
# objects of another.
function(navvy_define definition)
  foreach(file IN LISTS ARGN)
    if(NOT EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/${file})
      message(FATAL_ERROR "${definition} is defined for ${file}, which ${CMAKE_CURRENT_SOURCE_DIR} does not hold")
    endif()
  endforeach()
  set_property(SOURCE ${ARGN} APPEND PROPERTY COMPILE_DEFINITIONS ${definition})
endfunction()

# Generates tests/paths.h, by which a test or bench finds its tree. The first caller makes it.
function(navvy_paths)
  if(NOT TARGET navvy_paths)
    configure_file(${PROJECT_SOURCE_DIR}/tests/paths.cpp.in ${PROJECT_BINARY_DIR}/paths.cpp @ONLY)
    add_library(navvy_paths STATIC ${PROJECT_BINARY_DIR}/paths.cpp)
    target_include_directories(navvy_paths PUBLIC ${PROJECT_SOURCE_DIR}/tests)
  endif()
endfunction()

# Collects programs with label host, which run under sanitizers too; those with label untrusted,
# which CI runs under sanitizers; fuzz targets; and the precompiled headers, which clang-tidy needs
# before anything is compiled.
add_custom_target(navvy_host_tests)
add_custom_target(navvy_untrusted_tests)
add_custom_target(navvy_fuzzers)

# navvy_tests(NAME LABEL host|plain|device|slow [UNTRUSTED] [LIBS libs...] [PATTERN globs...]
# [EXTRA sources...] [TIMEOUT s] [PROPERTIES k v...]) Defines one GoogleTest program of all
# *_test.cpp files in this folder, or of those matching PATTERN. UNTRUSTED: the module reads files
# of unknown origin, so CI runs its tests under sanitizers.
function(navvy_tests name)
  cmake_parse_arguments(T "UNTRUSTED" "LABEL;TIMEOUT" "LIBS;EXTRA;PROPERTIES;PATTERN" ${ARGN})
  if(NOT T_PATTERN)
    set(T_PATTERN *_test.cpp)
  endif()
  if(NOT T_TIMEOUT)
    set(T_TIMEOUT 300)
  endif()
  list(TRANSFORM T_PATTERN PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)
  file(GLOB sources CONFIGURE_DEPENDS ${T_PATTERN})
  if(NOT sources)
    return()
  endif()
  add_executable(${name} ${sources} ${T_EXTRA})
  set(main GTest::gtest_main)
  if(T_LABEL STREQUAL "device")
    set(main "")
    target_sources(${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests/device_main.cpp)
    # Runs the whole program once more on a GPU; shows as skipped if there is none.
    add_test(NAME ${name}_on_gpu COMMAND ${name} --gtest_brief=1)
    set_tests_properties(${name}_on_gpu PROPERTIES LABELS "device" ENVIRONMENT "NAVVY_TEST_DEVICE=gpu" TIMEOUT 900
                         SKIP_REGULAR_EXPRESSION "^.  SKIPPED . no OpenCL device")
  endif()
  target_link_libraries(${name} PRIVATE navvy_flags ${T_LIBS} navvy_paths GTest::gtest ${main})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  # An EXPECT that is the whole branch of an if is unambiguous to a reader; the inner else of the
  # macro makes it ambiguous to GCC.
  target_compile_options(${name} PRIVATE -Wno-dangling-else)
  set(label ${T_LABEL})
  if(T_LABEL STREQUAL "host")
    add_dependencies(navvy_host_tests ${name})
  endif()
  if(T_UNTRUSTED)
    # One label for ctest -L, which matches parts: gtest_discover_tests takes no list of labels.
    set(label ${T_LABEL}-untrusted)
    target_sources(${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests/leak_suppressions.cpp)
    add_dependencies(navvy_untrusted_tests ${name})
  endif()
  if(NAVVY_PRECOMPILE)
    # Built as a program, since programs are compiled with other flags than libraries.
    if(NOT TARGET navvy_test_headers)
      file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/test_headers.cpp CONTENT "int main() {}\n")
      add_executable(navvy_test_headers ${PROJECT_BINARY_DIR}/test_headers.cpp)
      target_link_libraries(navvy_test_headers PRIVATE navvy_flags navvy::core GTest::gtest)
      target_precompile_headers(navvy_test_headers PRIVATE ${NAVVY_COMMON_HEADERS} <gtest/gtest.h>)
    endif()
    # Links core for its include directories: clang-tidy reads the precompiled headers as text.
    target_link_libraries(${name} PRIVATE navvy::core)
    target_precompile_headers(${name} REUSE_FROM navvy_test_headers)
  endif()
  include(GoogleTest)
  gtest_discover_tests(${name} TEST_PREFIX "" DISCOVERY_TIMEOUT 60
                       PROPERTIES LABELS "${label}" TIMEOUT ${T_TIMEOUT} ${T_PROPERTIES})
endfunction()

# navvy_fuzzer(NAME LIBS libs... [EXTRA sources...]): defines the libFuzzer target NAME.cpp of this
# folder, only with NAVVY_FUZZ.
function(navvy_fuzzer name)
  cmake_parse_arguments(F "" "" "LIBS;EXTRA" ${ARGN})
  if(NOT NAVVY_FUZZ OR NOT EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/${name}.cpp)
    return()
  endif()
  add_executable(${name} EXCLUDE_FROM_ALL ${name}.cpp ${PROJECT_SOURCE_DIR}/tests/leak_suppressions.cpp ${F_EXTRA})
  target_link_libraries(${name} PRIVATE navvy_flags ${F_LIBS})
  target_link_options(${name} PRIVATE -fsanitize=fuzzer)
  add_dependencies(navvy_fuzzers ${name})
  if(NAVVY_PRECOMPILE)
    target_precompile_headers(${name} REUSE_FROM navvy_test_headers)
  endif()
endfunction()
