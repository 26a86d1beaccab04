# SPDX-License-Identifier: Apache-2.0
cmake_minimum_required(VERSION 3.25)
# Run by the build: cmake -DPAGE_DIR=... -DLIBRARIES=... -DOUT=... -P EmbedPage.cmake writes one C++ file that holds the
# page of src/report/page with its styles and scripts in it, as a raw string.
file(READ ${PAGE_DIR}/page.html page)
set(styles "")
set(scripts "")

# Appends one file to the styles or scripts; a file that is missing is named in the page instead.
function(append_file variable tag path)
  if(EXISTS ${path})
    file(READ ${path} text)
    # A page has no files beside it that a debugger could read: cut the comment that ends the file
    # with their name. A regular expression would take a minute over these long lines.
    string(FIND "${text}" "# sourceMappingURL=" comment REVERSE)
    if(comment GREATER 2)
      math(EXPR comment "${comment} - 2")
      string(SUBSTRING "${text}" 0 ${comment} text)
    endif()
  else()
    message(WARNING "${path} is missing: pages of runs will lack what it draws (apt-get install libjs-three libjs-dygraphs)")
    set(text "/* missing when Navvy was built: ${path} */")
  endif()
  set(${variable} "${${variable}}<${tag}>\n${text}\n</${tag}>\n" PARENT_SCOPE)
endfunction()

append_file(styles style ${LIBRARIES}/dygraphs/dygraph.min.css)
append_file(styles style ${PAGE_DIR}/page.css)
foreach(library three/three.min.js three/examples/js/controls/OrbitControls.js dygraphs/dygraph.min.js
                dygraphs/extras/synchronizer.js)
  append_file(scripts script ${LIBRARIES}/${library})
endforeach()
# In the order of their dependence: main.js comes last.
file(GLOB own RELATIVE ${PAGE_DIR} ${PAGE_DIR}/*.js)
list(SORT own)
list(REMOVE_ITEM own main.js)
foreach(script IN LISTS own ITEMS main.js)
  append_file(scripts script ${PAGE_DIR}/${script})
endforeach()
string(REPLACE "<!--NAVVY:STYLES-->" "${styles}" page "${page}")
string(REPLACE "<!--NAVVY:SCRIPTS-->" "${scripts}" page "${page}")
set(text "// Generated from src/report/page/ by cmake/EmbedPage.cmake.\n#include \"report/page_template_private.h\"\n\n")
string(APPEND text "namespace navvy::report {\n\nstd::string_view page_template() {\n  return ")
# Compilers limit the length of one literal; neighbours are joined.
string(LENGTH "${page}" length)
set(at 0)
while(at LESS length)
  string(SUBSTRING "${page}" ${at} 16000 part)
  string(APPEND text "R\"navvy_page(${part})navvy_page\"\n")
  math(EXPR at "${at} + 16000")
endwhile()
string(APPEND text "      ;\n}\n\n}  // namespace navvy::report\n")
# A file that did not change keeps its time stamp, so that nothing is recompiled.
set(old "")
if(EXISTS ${OUT})
  file(READ ${OUT} old)
endif()
if(NOT old STREQUAL text)
  file(WRITE ${OUT} "${text}")
endif()
file(TOUCH ${OUT}.stamp)
