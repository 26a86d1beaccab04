# SPDX-License-Identifier: Apache-2.0
cmake_minimum_required(VERSION 3.25)
# cmake -DPROJECT=headers|modules|minimal|engine -DBINARY_DIR= -DSOURCE_DIR= -DCOMPILER= -DLAUNCHER= -DCORE_ONLY= -P install_test.cmake
set(work ${BINARY_DIR}/install-test/${PROJECT})
set(prefix ${work}/prefix)
file(REMOVE_RECURSE ${work})

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    string(REPLACE ";" " " command "${ARGN}")
    message(FATAL_ERROR "${command}\nended with ${result}:\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

run(${CMAKE_COMMAND} --install ${BINARY_DIR} --prefix ${prefix})
file(GLOB_RECURSE headers RELATIVE ${prefix}/include/navvy ${prefix}/include/navvy/*.h)
list(LENGTH headers count)
if(count LESS 15)
  message(FATAL_ERROR "only ${count} headers were installed")
endif()

# A foreign project: one source a header, one source a module, a copy of a folder
# beside this file, or a copy of examples/minimal.
if(PROJECT MATCHES "headers|modules")
  set(sources "")
  foreach(header IN LISTS headers)
    string(MAKE_C_IDENTIFIER ${header} name)
    if(PROJECT STREQUAL "modules")
      string(REGEX REPLACE "/.*" "" name ${header})
    endif()
    # Twice: a header guards itself.
    file(APPEND ${work}/source/${name}.cpp "#include \"${header}\"\n#include \"${header}\"\n")
    list(APPEND sources ${name}.cpp)
  endforeach()
  list(REMOVE_DUPLICATES sources)
  list(JOIN sources " " sources)
  file(WRITE ${work}/source/CMakeLists.txt
       "cmake_minimum_required(VERSION 3.25)\nproject(headers CXX)\nfind_package(navvy 0.1 REQUIRED)\n"
       "add_library(headers OBJECT ${sources})\ntarget_link_libraries(headers PRIVATE navvy::navvy)\n")
elseif(EXISTS ${SOURCE_DIR}/tests/install/${PROJECT})
  file(COPY ${SOURCE_DIR}/tests/install/${PROJECT}/ ${SOURCE_DIR}/tests/vehicle/engine_contract.h
       DESTINATION ${work}/source)
else()
  file(COPY ${SOURCE_DIR}/examples/${PROJECT}/ DESTINATION ${work}/source)
endif()
run(${CMAKE_COMMAND} -S ${work}/source -B ${work}/build -DCMAKE_PREFIX_PATH=${prefix} -DCMAKE_BUILD_TYPE=Release
    -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER})
run(${CMAKE_COMMAND} --build ${work}/build -j 2)
if(PROJECT STREQUAL "minimal")
  run(${work}/build/minimal)
  if(NOT output MATCHES "boom")
    message(FATAL_ERROR "the example did not say where the boom is:\n${output}")
  endif()
  message("${output}")
endif()
if(PROJECT STREQUAL "engine")
  run(${work}/build/engine --gtest_brief=1)
  message("${output}")
endif()
file(REMOVE_RECURSE ${work})
