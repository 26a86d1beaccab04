# SPDX-License-Identifier: Apache-2.0
cmake_minimum_required(VERSION 3.25)
# Run by the build: cmake -DKERNEL_DIR=... -DOUT=... -P EmbedKernels.cmake writes one C++ file that holds every kernel
# file as a raw string.
file(GLOB_RECURSE files RELATIVE ${KERNEL_DIR} ${KERNEL_DIR}/*.cl ${KERNEL_DIR}/*.h)
list(SORT files)
set(text "// Generated from kernels/ by cmake/EmbedKernels.cmake.\n#include \"device/embedded_private.h\"\n\n")
string(APPEND text "namespace navvy::device {\n\nconst EmbeddedFile* embedded_files() {\n  static const EmbeddedFile files[] = {\n")
foreach(path IN LISTS files)
  file(READ ${KERNEL_DIR}/${path} source)
  string(APPEND text "      {\"${path}\", R\"navvy_kernel(${source})navvy_kernel\"},\n")
endforeach()
string(APPEND text "      {nullptr, nullptr}};\n  return files;\n}\n\n}  // namespace navvy::device\n")
# A file that did not change keeps its time stamp, so that nothing is recompiled.
set(old "")
if(EXISTS ${OUT})
  file(READ ${OUT} old)
endif()
if(NOT old STREQUAL text)
  file(WRITE ${OUT} "${text}")
endif()
file(TOUCH ${OUT}.stamp)
