# SPDX-License-Identifier: Apache-2.0
# What `cmake --install` puts where, and the packages that CPack makes of it.
#
# Components: python (the package nacre), runtime (the program, scenes, what to read), library (libnacre.so.0 and what it and the
# program load) and development. Everything finds everything else by relative paths, so a prefix can
# be moved.
include(CMakePackageConfigHelpers)

# All that is compiled for it, as one target, and what stops an installation before it has copied
# anything: a file of these that is not built.
set(docs_folder ${CMAKE_BINARY_DIR}/docs)
set(installed_targets nacre nacre_shared)
if(NACRE_OIIO)
  list(APPEND installed_targets nacre_oiio)
endif()
if(TARGET nacre_python)
  list(APPEND installed_targets nacre_python)
endif()
add_custom_target(installed DEPENDS ${installed_targets} nacre_docs)
list(TRANSFORM installed_targets REPLACE "(.+)" "$<TARGET_FILE:\\1>" OUTPUT_VARIABLE installed_files)
install(CODE "
  foreach(file \"$<JOIN:${installed_files},\" \">\" \"${docs_folder}/nacre.1.gz\")
    if(NOT EXISTS \"\${file}\")
      message(FATAL_ERROR \" Nothing is installed: \${file} is not built yet: \"
        \"cmake --build '${CMAKE_BINARY_DIR}' --target installed\")
    endif()
  endforeach()"
  ALL_COMPONENTS)

install(TARGETS nacre RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT runtime)
if(NACRE_OIIO)
  install(TARGETS nacre_oiio
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/nacre COMPONENT library)
endif()
install(TARGETS nacre_shared EXPORT nacreTargets
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library NAMELINK_COMPONENT development
  INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
if(TARGET nacre_python)
  # Debian's place for all Pythons 3. An installation for others than the system finds its library by a
  # relative path; the system's is found anyway.
  set(python_folder lib/python3/dist-packages/nacre)
  if(NOT CMAKE_INSTALL_PREFIX STREQUAL "/usr")
    file(RELATIVE_PATH library_from_package
      /prefix/${python_folder} /prefix/${CMAKE_INSTALL_LIBDIR})
    set_target_properties(nacre_python PROPERTIES INSTALL_RPATH "$ORIGIN/${library_from_package}")
  endif()
  install(TARGETS nacre_python LIBRARY DESTINATION ${python_folder} COMPONENT python)
  get_property(python_files GLOBAL PROPERTY NACRE_PYTHON_FILES)
  install(FILES ${python_files} DESTINATION ${python_folder} COMPONENT python)
endif()
install(FILES src/nacre.h
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/nacre COMPONENT development)

# find_package(nacre) and pkg-config.
set(config_folder ${CMAKE_INSTALL_LIBDIR}/cmake/nacre)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/nacreConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
file(WRITE ${CMAKE_BINARY_DIR}/nacreConfig.cmake
  "# libnacre.so brings all that it needs: there is nothing else to find.\n"
  "include(\"\${CMAKE_CURRENT_LIST_DIR}/nacreTargets.cmake\")\n")
install(EXPORT nacreTargets NAMESPACE nacre:: DESTINATION ${config_folder} COMPONENT development)
install(FILES ${CMAKE_BINARY_DIR}/nacreConfig.cmake ${CMAKE_BINARY_DIR}/nacreConfigVersion.cmake
  DESTINATION ${config_folder} COMPONENT development)
set(pkgconfig_folder ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
file(RELATIVE_PATH prefix_from_pkgconfig
  ${CMAKE_INSTALL_PREFIX}/${pkgconfig_folder} ${CMAKE_INSTALL_PREFIX})
configure_file(${CMAKE_CURRENT_LIST_DIR}/nacre.pc.in ${CMAKE_BINARY_DIR}/nacre.pc @ONLY)
install(FILES ${CMAKE_BINARY_DIR}/nacre.pc
  DESTINATION ${pkgconfig_folder} COMPONENT development)

# The manual page and the shell's completion, which the program writes itself.
file(MAKE_DIRECTORY ${docs_folder})
add_custom_command(OUTPUT ${docs_folder}/nacre.1.gz ${docs_folder}/nacre
  COMMAND nacre docs man > ${docs_folder}/nacre.1
  COMMAND gzip -9nc ${docs_folder}/nacre.1 > ${docs_folder}/nacre.1.gz
  COMMAND nacre docs bash > ${docs_folder}/nacre
  DEPENDS nacre
  COMMENT "Writing the manual page")
add_custom_target(nacre_docs ALL DEPENDS ${docs_folder}/nacre.1.gz ${docs_folder}/nacre)
install(FILES ${docs_folder}/nacre.1.gz
  DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT runtime)
install(FILES ${docs_folder}/nacre
  DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT runtime)

# Scenes with their schema and files, and what to read: the READMEs in their places, without pictures.
install(DIRECTORY scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/nacre COMPONENT runtime
  PATTERN gallery EXCLUDE PATTERN README.md EXCLUDE)
foreach(folder "" /scenes /src /src/cli /bench /tests /scripts)
  install(FILES .${folder}/README.md DESTINATION ${CMAKE_INSTALL_DOCDIR}${folder} COMPONENT runtime)
endforeach()

# scripts/package: nacre_*.deb, libnacre0_*.deb and libnacre-dev_*.deb.
# Nobody answers mail for nacre, and the ending says so (RFC 2606). Who passes packages on gives a name
# of their own: scripts/package takes it from DEBFULLNAME and DEBEMAIL.
set(NACRE_MAINTAINER "The nacre authors <nobody@nacre.invalid>" CACHE STRING "Of the packages")

# Debian has the licence's text in one place for all packages. Others get the text itself: it belongs
# to no package.
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT license)
string(TIMESTAMP package_date "%a, %d %b %Y %H:%M:%S +0000" UTC)
set(package_parts runtime library development)
set(package_names nacre libnacre0 libnacre-dev)
if(TARGET nacre_python)
  list(APPEND package_parts python)
  list(APPEND package_names python3-nacre)
endif()
foreach(part name IN ZIP_LISTS package_parts package_names)
  set(folder ${CMAKE_BINARY_DIR}/package/${name})
  configure_file(${CMAKE_CURRENT_LIST_DIR}/copyright.in ${folder}/copyright @ONLY)
  file(CONFIGURE OUTPUT ${folder}/changelog @ONLY CONTENT
    "nacre (@PROJECT_VERSION@) unstable; urgency=low\n\n  * See the commits.\n\n -- @NACRE_MAINTAINER@  @package_date@\n")
  execute_process(COMMAND gzip -9nf ${folder}/changelog)
  install(FILES ${folder}/copyright ${folder}/changelog.gz
    DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${name} COMPONENT ${part})
endforeach()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME nacre)
set(CPACK_PACKAGE_CONTACT "${NACRE_MAINTAINER}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL ${package_parts})
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
# The library's numbers promise nothing yet: who links it needs this very version.
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY "=")
set(CPACK_COMPONENT_RUNTIME_DEPENDS library)
set(CPACK_COMPONENT_DEVELOPMENT_DEPENDS library)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME nacre)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_RUNTIME_DESCRIPTION "The program: renders the Phong family and physically based reflection models
on spheres and meshes in comparable units, as linear HDR EXR and tone-mapped
PNG, and compares, measures and plots them.")
# Labels in pictures, and diagrams.
set(CPACK_DEBIAN_RUNTIME_PACKAGE_RECOMMENDS "fonts-dejavu-core, gnuplot-nox")
file(WRITE ${CMAKE_BINARY_DIR}/package/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA ${CMAKE_BINARY_DIR}/package/triggers)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libnacre0)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBRARY_DESCRIPTION "The library: renders scenes built in C++ code or read from files, evaluates
reflection models and compares images.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libnacre-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "Header, CMake package and pkg-config file of the library.")
set(CPACK_COMPONENT_PYTHON_DEPENDS library)
# Where dpkg-shlibdeps finds the library that the module is linked with.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_BINARY_DIR})
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-nacre)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
# The module is for the Python that it was built with.
if(TARGET nacre_python)
  get_property(python_version GLOBAL PROPERTY NACRE_PYTHON_VERSION)
  string(REGEX MATCH "^([0-9]+)\\.([0-9]+)" python_version "${python_version}")
  math(EXPR next_minor "${CMAKE_MATCH_2} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
    "python3 (>= ${python_version}), python3 (<< ${CMAKE_MATCH_1}.${next_minor}), python3-numpy")
endif()
set(CPACK_DEBIAN_PYTHON_DESCRIPTION "The library in Python: scenes, renders, images as numpy arrays, reflection
models over arrays, and checks and renders of one's own.")
include(CPack)
