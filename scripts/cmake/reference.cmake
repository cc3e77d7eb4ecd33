# SPDX-License-Identifier: Apache-2.0
# The target nacre_reference, where Doxygen is installed: nacre.h as HTML pages, in docs/reference of
# the build folder.
find_package(Doxygen QUIET)
if(DOXYGEN_FOUND)
  set(DOXYGEN_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/docs/reference)
  set(DOXYGEN_HTML_OUTPUT .)
  set(DOXYGEN_PROJECT_BRIEF "nacre as a C++ library")
  set(DOXYGEN_INPUT_FILTER ${CMAKE_CURRENT_LIST_DIR}/doxygen_comments.sed)
  set(DOXYGEN_EXTRACT_ALL YES)
  set(DOXYGEN_JAVADOC_AUTOBRIEF YES)
  set(DOXYGEN_SORT_MEMBER_DOCS NO)
  set(DOXYGEN_HAVE_DOT NO)
  set(DOXYGEN_SHOW_INCLUDE_FILES NO)
  # As users see it: without the marks of symbols and of the library's own sources.
  set(DOXYGEN_MACRO_EXPANSION YES)
  set(DOXYGEN_PREDEFINED "NACRE_API=")
  set(DOXYGEN_EXPAND_ONLY_PREDEF YES)
  set(DOXYGEN_WARN_AS_ERROR FAIL_ON_WARNINGS)
  set(DOXYGEN_QUIET YES)
  set(DOXYGEN_STRIP_FROM_PATH ${CMAKE_SOURCE_DIR}/src)
  doxygen_add_docs(nacre_reference ${CMAKE_SOURCE_DIR}/src/nacre.h
    WORKING_DIRECTORY ${CMAKE_BINARY_DIR} COMMENT "Writing the reference of nacre.h")
endif()
