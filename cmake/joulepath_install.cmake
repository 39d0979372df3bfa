# cmake --install: program, library with headers, find_package(joulepath CONFIG), pkg-config, scenarios, documents.
include(CMakePackageConfigHelpers)

get_property(modules GLOBAL PROPERTY JOULEPATH_MODULES)
set(config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/joulepath)

# joulepath::joulepath is all modules; <joulepath/model/motor.hpp> and "model/motor.hpp" both resolve.
add_library(joulepath_all INTERFACE)
add_library(joulepath::joulepath ALIAS joulepath_all)
target_link_libraries(joulepath_all INTERFACE ${modules})
target_include_directories(joulepath_all INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
set_target_properties(joulepath_all PROPERTIES EXPORT_NAME joulepath)

install(TARGETS joulepath RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(TARGETS ${modules} joulepath_all EXPORT joulepathTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
        INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/joulepath)
install(EXPORT joulepathTargets NAMESPACE joulepath:: DESTINATION ${config_dir})
# Files of a folder of the source, by regular expressions of their paths. install(DIRECTORY) would leave an empty folder
# where it leaves out every file.
function(joulepath_install_files folder destination included excluded)
  file(GLOB_RECURSE files LIST_DIRECTORIES false RELATIVE ${PROJECT_SOURCE_DIR} CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${folder}/*)
  list(FILTER files INCLUDE REGEX "${included}")
  list(FILTER files EXCLUDE REGEX "${excluded}")
  foreach(file IN LISTS files)
    get_filename_component(place ${file} DIRECTORY)
    install(FILES ${PROJECT_SOURCE_DIR}/${file} DESTINATION ${destination}/${place})
  endforeach()
endfunction()

foreach(room model planner diagnosis scenarios)
  joulepath_install_files(${room} ${CMAKE_INSTALL_INCLUDEDIR}/joulepath "[.]hpp$" "^$")
endforeach()
get_property(readers GLOBAL PROPERTY JOULEPATH_READERS)
foreach(name IN LISTS readers) # of the library, not of the program
  joulepath_install_files(extensions/${name} ${CMAKE_INSTALL_INCLUDEDIR}/joulepath "[.]hpp$" "/(tests|commands)/")
endforeach()
foreach(name IN LISTS JOULEPATH_DEPENDENCY_FILES)
  install(FILES extensions/${name}/dependencies.cmake DESTINATION ${config_dir} RENAME joulepath_${name}.cmake)
endforeach()

configure_package_config_file(cmake/joulepathConfig.cmake.in joulepathConfig.cmake INSTALL_DESTINATION ${config_dir})
write_basic_package_version_file(joulepathConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/joulepathConfig.cmake ${PROJECT_BINARY_DIR}/joulepathConfigVersion.cmake
              cmake/joulepath_dependencies.cmake DESTINATION ${config_dir})

# pkg-config: static libraries in one group, then what they need.
set(PC_LIBS "")
foreach(module IN LISTS modules)
  get_target_property(type ${module} TYPE)
  if(type STREQUAL STATIC_LIBRARY)
    string(APPEND PC_LIBS "-l${module} ")
  endif()
endforeach()
string(JOIN " " PC_REQUIRES ipopt yaml-cpp nlopt libpng ${JOULEPATH_PKG_CONFIG})
set(PC_SYSTEM_LIBS "-lompl -pthread")
set(PC_CFLAGS "-I${OMPL_INCLUDE_DIR} -I${EIGEN3_INCLUDE_DIR}")
file(RELATIVE_PATH PC_TO_PREFIX "/prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig" "/prefix")
configure_file(cmake/joulepath.pc.in joulepath.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/joulepath.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

joulepath_install_files(scenarios ${CMAKE_INSTALL_DATADIR}/joulepath "." "([.][ch]pp|/CMakeLists[.]txt)$|^scenarios/schemas/")
install(FILES README.md CHANGELOG.md LICENSE THIRD_PARTY_NOTICES.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright) # where Debian looks
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR})
# Man page and completions come from the program's own help.
find_package(Python3 COMPONENTS Interpreter REQUIRED)
set(manual ${PROJECT_BINARY_DIR}/joulepath.1)
add_custom_command(OUTPUT ${manual} DEPENDS joulepath app/manual/write_manual.py
  COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/app/manual/write_manual.py $<TARGET_FILE:joulepath> ${manual})
set(completion ${PROJECT_BINARY_DIR}/completion.bash)
add_custom_command(OUTPUT ${completion} DEPENDS joulepath COMMAND joulepath completion bash > ${completion})
add_custom_target(joulepath_manual ALL DEPENDS ${manual} ${completion})
install(FILES ${completion} DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME joulepath)
install(FILES ${manual} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES package.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/joulepath)

# cpack -G DEB --config build/release/CPackConfig.cmake
set(CPACK_PACKAGE_NAME joulepath)
set(CPACK_PACKAGE_CONTACT "the joulepath authors <joulepath@example.org>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_GENERATOR DEB)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON) # names the shared libraries' packages
set(CPACK_DEBIAN_PACKAGE_SUGGESTS
    "coinor-libipopt-dev, liblapack-dev, libblas-dev, libeigen3-dev, libnlopt-dev, libompl-dev, libyaml-cpp-dev, nlohmann-json3-dev, libpng-dev, zlib1g-dev, liblz4-dev, libzstd-dev, libsqlite3-dev, libtinyxml2-dev, pkg-config")
include(CPack)
