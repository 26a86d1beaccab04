# SPDX-License-Identifier: Apache-2.0
# `cmake --install`: headers, libraries, data and the find_package(navvy) package.
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/navvy)
get_property(modules GLOBAL PROPERTY NAVVY_MODULES)

# External dependencies of the static libraries, as find calls of the package file: Name::Target
# comes from package Name, PkgConfig::NAME from the pkg-config module of that name.
set(outside "")
foreach(module IN LISTS modules)
  foreach(property LINK_LIBRARIES INTERFACE_LINK_LIBRARIES)
    get_target_property(libraries ${module} ${property})
    if(libraries)
      list(APPEND outside ${libraries})
    endif()
  endforeach()
endforeach()
list(FILTER outside INCLUDE REGEX "^[A-Za-z0-9_]+::")
list(REMOVE_DUPLICATES outside)
list(SORT outside)
set(NAVVY_FIND_CALLS "")
foreach(library IN LISTS outside)
  string(REGEX REPLACE "::.*" "" package ${library})
  string(REGEX REPLACE ".*::" "" target ${library})
  if(package STREQUAL "PkgConfig")
    string(APPEND NAVVY_FIND_CALLS "find_dependency(PkgConfig)\npkg_check_modules(${target} REQUIRED QUIET IMPORTED_TARGET ${${target}_MODULE_NAME})\n")
  elseif(NOT package STREQUAL "navvy")
    string(APPEND NAVVY_FIND_CALLS "find_dependency(${package})\n")
  endif()
endforeach()

# navvy::navvy links every module.
add_library(navvy_all INTERFACE)
add_library(navvy::navvy ALIAS navvy_all)
set_target_properties(navvy_all PROPERTIES EXPORT_NAME navvy)
target_link_libraries(navvy_all INTERFACE ${modules})

install(TARGETS ${modules} navvy_all EXPORT navvy ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}/navvy)
install(EXPORT navvy NAMESPACE navvy:: FILE navvyTargets.cmake DESTINATION ${package_dir})

# Headers that include a third-party library other than Eigen, or a kernel's header, are private,
# and so are the headers that include them: a program that links Navvy needs none of those
# libraries' headers.
set(public_headers "")
foreach(module IN LISTS modules)
  string(REGEX REPLACE "^navvy_" "" folder ${module})
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/src/${folder}/*.h)
  list(APPEND public_headers ${headers})
endforeach()
list(FILTER public_headers EXCLUDE REGEX "_private\\.h$")
set(before 0)
list(LENGTH public_headers count)
while(NOT before EQUAL count)
  set(before ${count})
  foreach(header IN LISTS public_headers)
    file(STRINGS ${PROJECT_SOURCE_DIR}/src/${header} includes REGEX "^ *# *include ")
    foreach(include IN LISTS includes)
      string(REGEX REPLACE "^[^<\"]*[<\"]([^>\"]*)[>\"].*$" "\\1" name "${include}")
      if((include MATCHES "<" AND name MATCHES "[./]" AND NOT name MATCHES "^(Eigen|sys)/") OR
         (include MATCHES "\"" AND NOT name IN_LIST public_headers))
        list(REMOVE_ITEM public_headers ${header})
        break()
      endif()
    endforeach()
  endforeach()
  list(LENGTH public_headers count)
endwhile()
foreach(header IN LISTS public_headers)
  get_filename_component(folder ${header} DIRECTORY)
  install(FILES ${PROJECT_SOURCE_DIR}/src/${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/navvy/${folder})
endforeach()

foreach(data vehicles buckets sensors terrain scenarios)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/${data} DESTINATION ${CMAKE_INSTALL_DATADIR}/navvy)
endforeach()

set(data_dir ${CMAKE_INSTALL_DATADIR}/navvy)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/navvyConfig.cmake.in ${PROJECT_BINARY_DIR}/navvyConfig.cmake
                              INSTALL_DESTINATION ${package_dir} PATH_VARS data_dir)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/navvyConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/navvyConfig.cmake ${PROJECT_BINARY_DIR}/navvyConfigVersion.cmake
        DESTINATION ${package_dir})
